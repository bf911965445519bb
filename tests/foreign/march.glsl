#version 330 core
uniform vec2 u_resolution;
const float RADIUS = 1.25;
float sdf(vec3 p) { return length(p - vec3(-1.6, 1.0, 0.0)) - RADIUS; }
void main() {
  vec3 eye = vec3(3.0, 3.5, 8.0);
  float fov = 0.785;
  gl_FragColor = vec4(0.5, 0.5, 0.0, 1.0);
}
