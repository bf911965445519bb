#include <stdio.h>
#define WIDTH 640
static const float fov = 45.0f;
int samples = 16;
double radius = 1.25;
vec3 center = { -1.6, 1, 0 };
struct sphere ball = { { 2, 1, 4 }, 0.75 };
