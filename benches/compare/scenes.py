"""Converts the output of `pinhole inspect` to POV-Ray and Mitsuba: scenes.py INSPECTED FOLDER

The converted scenes have the same camera, shapes and flat colours. Both programs get the camera's
axes as they are, so that nothing is left to their own rules for axes, and colours in linear light.
"""

import json
import os
import sys
from math import log
from struct import pack

# Mitsuba has no infinite plane and computes with 32-bit floats. A checkerboard becomes one square,
# which extends INNERMOST fields from the origin to each side, and RINGS rings around it. Each ring
# is RING times as wide as everything inside it. With a single huge rectangle, positions near the
# camera would be too imprecise. In figure 9.9, the part that is missing at the horizon is a
# fortieth of a pixel high, as the camera is 3.5 above the floor.
INNERMOST = 32.0
RING = 8.0
RINGS = 4

# Minimum number of spheres of one colour that Mitsuba gets as a single shape. Its JIT compiler
# takes time for every shape.
CLOUD = 100

# Minimum radius of spheres that share a shape. If an ellipsoid is much smaller than 1, Mitsuba's
# rays hit its bounds instead of its surface. Therefore, the whole scene, including the camera's
# position, is enlarged. This does not change the picture.
SMALLEST = 4.0


def main():
    with open(sys.argv[1]) as file:
        scene = json.load(file)
    write(sys.argv[2], "scene.pov", povray(scene).encode())
    for name, content in mitsuba(scene).items():
        write(sys.argv[2], name, content)


def write(folder, name, content):
    with open(os.path.join(folder, name), "wb") as file:
        file.write(content)


def linear(color):
    """Returns the linear light of `#rrggbb`."""
    encoded = [int(color[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in encoded]


def colors(scene):
    """Returns the colours of all objects except checkerboards, each once: objects of one colour
    share a texture or a material."""
    return sorted({thing["color"] for thing in scene["objects"] if "color" in thing})


def povray(scene):
    """Returns a scene for POV-Ray 3.7."""
    image, camera = scene["image"], scene["camera"]

    def vector(values):
        return "<" + ", ".join(map(repr, values)) + ">"

    def scaled(axis, by):
        return vector([by * value for value in camera[axis]])

    # POV-Ray's picture is as wide as `right` and as tall as `up`, at the distance of `direction`.
    # POV-Ray uses left-handed axes only for cameras that are given by `look_at`, which is not used
    # here.
    height = camera["view_height"]
    lines = [
        "#version 3.7;",
        "global_settings { assumed_gamma 1 }",
        "#default { finish { ambient 0 diffuse 0 emission 1 } }",
        f"camera {{ location {vector(camera['eye'])} direction {scaled('w', -camera['d'])}",
        f"  right {scaled('u', height * image['width'] / image['height'])} up {scaled('v', height)} }}",
    ]
    for value in colors(scene):
        lines.append(f"#declare C{value[1:]} = texture {{ pigment {{ rgb {vector(linear(value))} }} }}")
    for thing in scene["objects"]:
        match thing["kind"]:
            case "sphere":
                shape = f"sphere {{ {vector(thing['center'])}, {thing['radius']!r}"
            case "triangle":
                shape = "triangle { " + ", ".join(vector(vertex) for vertex in thing["vertices"])
            case "box":
                shape = f"box {{ {vector(thing['min'])}, {vector(thing['max'])}"
            case "checkerboard":
                # POV-Ray's pattern consists of cubes. A shift by half a cube puts the plane into
                # the middle of a layer of cubes in which even squares have the first colour.
                first, second = (f"rgb {vector(linear(color))}" for color in thing["colors"])
                square, y = thing["square"], thing["y"]
                lines.append(
                    f"plane {{ y, {y!r} pigment {{ checker {first}, {second} "
                    f"scale {square!r} translate <0, {y - square / 2!r}, 0> }} }}"
                )
                continue
        lines.append(f"{shape} texture {{ C{thing['color'][1:]} }} }}")
    return "\n".join(lines) + "\n"


def mitsuba(scene):
    """Returns the files of a scene for Mitsuba 3, by name. Its integrator of arbitrary output
    variables gives the albedo as it is."""
    alike = {}
    for thing in scene["objects"]:
        if thing["kind"] == "sphere":
            alike.setdefault(thing["color"], []).append(thing)
    clouds = {value: spheres for value, spheres in alike.items() if len(spheres) >= CLOUD}
    if clouds:
        smallest = min(sphere["radius"] for spheres in clouds.values() for sphere in spheres)
        enlarge(scene, max(1.0, SMALLEST / smallest))
    image, camera = scene["image"], scene["camera"]

    def point(values):
        return ", ".join(f"{value:.9g}" for value in values)

    def color(name, value):
        return f'<rgb name="{name}" value="{point(linear(value))}"/>'

    def put(scale, to):
        """Returns the transformation of a unit shape."""
        return f'<transform name="to_world">{scale}<translate value="{point(to)}"/></transform>'

    target = [e - w for e, w in zip(camera["eye"], camera["w"])]
    lines = [
        '<scene version="3.0.0">',
        '<default name="samples" value="16"/><default name="sampler" value="independent"/>',
        '<integrator type="aov"><string name="aovs" value="albedo:albedo"/></integrator>',
        '<sensor type="perspective">',
        f'<float name="fov" value="{camera["fov_deg"]:.17g}"/><string name="fov_axis" value="y"/>',
        '<float name="near_clip" value="0.1"/><float name="far_clip" value="1e6"/>',
        f'<transform name="to_world"><lookat origin="{point(camera["eye"])}" target="{point(target)}" '
        f'up="{point(camera["v"])}"/></transform>',
        '<sampler type="$sampler"><integer name="sample_count" value="$samples"/></sampler>',
        f'<film type="hdrfilm"><integer name="width" value="{image["width"]}"/>'
        f'<integer name="height" value="{image["height"]}"/><string name="component_format" value="float32"/>'
        '<rfilter type="box"/></film>',
        "</sensor>",
    ]
    files = {}
    for value in colors(scene):
        lines.append(f'<bsdf type="diffuse" id="{value[1:]}">{color("reflectance", value)}</bsdf>')
    for value, spheres in clouds.items():
        name = f"spheres_{value[1:]}.ply"
        files[name] = cloud(spheres)
        lines.append(
            f'<shape type="ellipsoids"><string name="filename" value="{name}"/><float name="extent" value="1"/>'
            f'<ref id="{value[1:]}"/></shape>'
        )
    for thing in scene["objects"]:
        match thing["kind"]:
            case "sphere":
                if thing["color"] in clouds:
                    continue
                center = " ".join(f'{axis}="{value:.9g}"' for axis, value in zip("xyz", thing["center"]))
                shape = f'<shape type="sphere"><point name="center" {center}/><float name="radius" value="{thing["radius"]:.9g}"/>'
            case "triangle":
                name = f"triangle_{thing['index']}.obj"
                corners = "".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in thing["vertices"])
                files[name] = (corners + "f 1 2 3\n").encode()
                shape = f'<shape type="obj"><string name="filename" value="{name}"/>'
            case "box":
                low, high = thing["min"], thing["max"]
                middle = [(a + b) / 2 for a, b in zip(low, high)]
                half = [(b - a) / 2 for a, b in zip(low, high)]
                shape = '<shape type="cube">' + put(f'<scale value="{point(half)}"/>', middle)
            case "checkerboard":
                lines += floor(thing, color, put)
                continue
        lines.append(f'{shape}<ref id="{thing["color"][1:]}"/></shape>')
    files["scene.xml"] = ("\n".join(lines) + "\n</scene>\n").encode()
    return files


def enlarge(scene, by):
    """Multiplies all positions and lengths, except those of the camera's window."""
    for thing in [scene["camera"], *scene["objects"]]:
        for key in ["eye", "center", "min", "max"]:
            if key in thing:
                thing[key] = [by * value for value in thing[key]]
        for key in ["radius", "y", "square"]:
            if key in thing:
                thing[key] *= by
        if "vertices" in thing:
            thing["vertices"] = [[by * value for value in vertex] for vertex in thing["vertices"]]


def cloud(spheres):
    """Returns spheres as a file of Mitsuba's ellipsoids: center, an unused normal, logarithms of
    the radii, the identity rotation."""
    fields = "x y z nx ny nz scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3".split()
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(spheres)}"]
    header += [f"property float {field}" for field in fields] + ["end_header", ""]
    rows = (
        pack("<13f", *sphere["center"], 0, 0, 0, *[log(sphere["radius"])] * 3, 1, 0, 0, 0) for sphere in spheres
    )
    return "\n".join(header).encode() + b"".join(rows)


def floor(thing, color, put):
    """Yields a square about the origin, and rings of four rectangles each around it."""
    square = thing["square"]
    first, second = thing["colors"]
    inner = INNERMOST * square
    parts = [(-inner, -inner, inner, inner)]
    for _ in range(RINGS):
        outer = inner * RING
        parts += [
            (-outer, -outer, outer, -inner),
            (-outer, inner, outer, outer),
            (-outer, -inner, -inner, inner),
            (inner, -inner, outer, inner),
        ]
        inner = outer
    for x0, z0, x1, z1 in parts:
        # The texture repeats whenever a texture coordinate passes a whole number. It shows `color0`
        # where both coordinates are in the first half of a period, or both in the second half. The
        # rectangle is turned to face up, so its second coordinate increases towards negative z. The
        # field at its corner (0, 0) is therefore odd, and `color0` is the colour of odd fields.
        half = [(x1 - x0) / 2, (z1 - z0) / 2]
        repeat = [side / square for side in half]
        yield (
            '<shape type="rectangle">'
            + put(
                f'<scale value="{half[0]:.9g}, {half[1]:.9g}, 1"/><rotate x="1" angle="-90"/>',
                [(x0 + x1) / 2, thing["y"], (z0 + z1) / 2],
            )
            + '<bsdf type="diffuse"><texture type="checkerboard" name="reflectance">'
            + color("color0", second)
            + color("color1", first)
            + f'<transform name="to_uv"><scale value="{repeat[0]:.9g}, {repeat[1]:.9g}, 1"/></transform>'
            + "</texture></bsdf></shape>"
        )


if __name__ == "__main__":
    main()
