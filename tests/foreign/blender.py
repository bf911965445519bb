import bpy
from math import radians

bpy.ops.mesh.primitive_uv_sphere_add(radius=1.2, location=(-1.6, 0, 1))
bpy.ops.mesh.primitive_cube_add(size=2, location=(2, 0.5, 0.75))
cam = bpy.data.objects["Camera"]
cam.location = (3, -8, 3.5)
cam.rotation_euler = (radians(70), 0, radians(20))
cam.data.lens = 35
