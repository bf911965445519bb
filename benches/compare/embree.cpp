// Renders the spheres of `cargo bench --bench many -- --write COUNT` by Embree, as seen from the
// origin along −z: 1280 × 720 pixels, four jittered samples in each, two threads. Prints the CPU
// seconds of all threads, for building the hierarchy and for rendering.
//
//     g++ -O3 -march=native -o embree benches/compare/embree.cpp -lembree3 -lpthread
//     ./embree spheres.scn
//
// The program does only the work that the picture needs: it traces the four rays of a pixel
// together, and stores the mean of their brightnesses. No file is written.

#include <embree3/rtcore.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <thread>
#include <vector>

namespace {

constexpr int WIDTH = 1280, HEIGHT = 720, SAMPLES = 4;
constexpr float DISTANCE = 2.75f, VIEW_HEIGHT = 2.0f;

double cpu_seconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

struct Sphere {
    float x, y, z, radius;
};

std::vector<Sphere> read(const char* path) {
    std::vector<Sphere> spheres;
    FILE* file = std::fopen(path, "r");
    char line[512];
    Sphere s;
    while (file && std::fgets(line, sizeof line, file)) {
        if (std::sscanf(line, "sphere { center (%f, %f, %f) radius %f", &s.x, &s.y, &s.z, &s.radius) == 4) {
            spheres.push_back(s);
        }
    }
    if (file) std::fclose(file);
    return spheres;
}

// Returns the brightness of a sphere, by the sphere's index. Any other values would do.
float brightness(unsigned sphere) {
    return float(sphere % 251) / 251.0f;
}

void render_row(RTCScene scene, int y, float* row) {
    std::minstd_rand random(unsigned(y) + 1);
    std::uniform_real_distribution<float> within(0.0f, 1.0f);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const float side = VIEW_HEIGHT / HEIGHT;
    for (int x = 0; x < WIDTH; ++x) {
        alignas(16) const int valid[SAMPLES] = {-1, -1, -1, -1};
        RTCRayHit4 rays;
        for (int k = 0; k < SAMPLES; ++k) {
            rays.ray.org_x[k] = rays.ray.org_y[k] = rays.ray.org_z[k] = 0.0f;
            rays.ray.dir_x[k] = (float(x) + 0.5f * (float(k % 2) + within(random)) - 0.5f * WIDTH) * side;
            rays.ray.dir_y[k] = (0.5f * HEIGHT - float(y) - 0.5f * (float(k / 2) + within(random))) * side;
            rays.ray.dir_z[k] = -DISTANCE;
            rays.ray.tnear[k] = 0.0f;
            rays.ray.tfar[k] = INFINITY;
            rays.ray.time[k] = 0.0f;
            rays.ray.mask[k] = ~0u;
            rays.ray.flags[k] = 0;
            rays.hit.geomID[k] = rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect4(valid, scene, &context, &rays);
        float sum = 0.0f;
        for (int k = 0; k < SAMPLES; ++k) {
            if (rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID) sum += brightness(rays.hit.primID[k]);
        }
        row[x] = sum / SAMPLES;
    }
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: embree SCENE\n");
        return 2;
    }
    const std::vector<Sphere> spheres = read(arguments[1]);
    const double start = cpu_seconds();
    RTCDevice device = rtcNewDevice("threads=2");
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres.data(), 0, sizeof(Sphere),
                               spheres.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
    const double built = cpu_seconds();
    std::vector<float> film(size_t(WIDTH) * HEIGHT);
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int y; (y = next++) < HEIGHT;) render_row(scene, y, &film[size_t(y) * WIDTH]);
    };
    std::thread other(work);
    work();
    other.join();
    const double done = cpu_seconds();
    double sum = 0.0;
    for (float light : film) sum += light;
    std::printf("%zu spheres: build %.3f CPU s, render %.3f CPU s, mean %.6f\n", spheres.size(), built - start, done - built,
                sum / double(film.size()));
}
