void setup() { size(640, 480, P3D); }
void draw() {
  background(30, 60, 120);
  camera(3, 3.5, 8, 0.2, 0.8, 0, 0, 1, 0);
  translate(-1.6, 1, 0); sphere(1.25);
}
