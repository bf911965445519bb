import numpy as np
from tracer import Camera, Sphere

WIDTH, HEIGHT = 640, 480
eye = np.array([3, 3.5, 8])
camera = Camera(eye=eye, lookat=(0.2, 0.8, 0), fov=45)
balls = [Sphere(center=(x, 1, 2 * x), radius=0.5) for x in range(7)]
if __name__ == "__main__":
    camera.render(balls, samples=16)
