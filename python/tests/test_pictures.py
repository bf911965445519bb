"""Tests that pictures have the bytes and numbers that the program writes."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pinhole
import pytest
from conftest import TEXT, Program
from PIL import Image

CROP = (30, 20, 40, 25)


def floats(path: Path) -> np.ndarray:
    """Reads an EXR file with the library of the format's authors."""
    pixels: np.ndarray = OpenEXR.File(str(path)).channels()["RGB"].pixels
    return pixels


@pytest.mark.parametrize("ending", ["png", "exr"])
@pytest.mark.parametrize("crop", [None, CROP])
def test_a_file_has_the_bytes_that_the_program_writes(
    program: Program, tmp_path: Path, ending: str, crop: pinhole.Crop | None
) -> None:
    options = ["--crop", ",".join(map(str, crop))] if crop else []
    sets = ["--set", "camera.roll=8deg", "--set", "Ball.center=(-1.6, 1.25, 0)"]
    said = program("render", "a.scn", "-o", f"theirs.{ending}", *options, *sets)
    assert said.returncode == 0, said.stderr
    settings = {"camera.roll": "8deg", "Ball.center": (-1.6, 1.25, 0)}
    scene = pinhole.load(tmp_path / "a.scn", set=settings)
    scene.save(tmp_path / f"ours.{ending}", crop=crop)
    theirs = (tmp_path / f"theirs.{ending}").read_bytes()
    assert (tmp_path / f"ours.{ending}").read_bytes() == theirs
    without = pinhole.load(tmp_path / "a.scn")
    without.save(tmp_path / f"without.{ending}", crop=crop)
    assert (tmp_path / f"without.{ending}").read_bytes() != theirs


def test_arrays_are_the_pixels_of_the_files(scene: pinhole.Scene, tmp_path: Path) -> None:
    scene.save(tmp_path / "a.png")
    scene.save(tmp_path / "a.exr")
    bytes_, light = scene.render(), scene.render_linear()
    assert (bytes_.dtype.name, bytes_.shape) == ("uint8", (64, 96, 3))
    assert (light.dtype.name, light.shape) == ("float64", (64, 96, 3))
    np.testing.assert_array_equal(bytes_, np.asarray(Image.open(tmp_path / "a.png")))
    np.testing.assert_array_equal(light.astype(np.float32), floats(tmp_path / "a.exr"))
    assert len(np.unique(bytes_)) > 20


def test_light_becomes_bytes_by_the_curve_of_srgb(scene: pinhole.Scene) -> None:
    light = scene.render_linear()
    curve = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    bytes_ = scene.render()
    np.testing.assert_array_equal(bytes_, np.rint(255 * curve))
    assert (bytes_ != np.rint(255 * light)).mean() > 0.1


def test_exact_means_are_within_their_bounds(scene: pinhole.Scene, tmp_path: Path) -> None:
    means, bounds = scene.render_exact()
    assert (bounds.dtype.name, bounds.shape) == ("float32", (64, 96))
    assert 0 < bounds.max() < 1e-9
    exact = pinhole.Scene(TEXT, set={"sampler.method": "exact"})
    np.testing.assert_array_equal(exact.render_linear(), means)
    exact.save(tmp_path / "a.exr")
    np.testing.assert_array_equal(means.astype(np.float32), floats(tmp_path / "a.exr"))
    few, many = (
        pinhole.Scene(TEXT, set={"sampler.per_pixel": count}).render_linear()
        for count in (16, 4096)
    )
    few_rmse, many_rmse = (np.sqrt(np.mean((light - means) ** 2)) for light in (few, many))
    assert many_rmse < 0.002 < few_rmse < 0.06


def test_the_exact_mean_of_a_known_pixel() -> None:
    # The triangle covers the lower left half of the only pixel, whose light it halves.
    text = """
        image { width 1  height 1 }
        camera { eye (0, 0, 1)  lookat (0, 0, 0)  d 1 }
        triangle { v0 (-1, -1, 0)  v1 (1, -1, 0)  v2 (-1, 1, 0)  color white }
    """
    means, bounds = pinhole.Scene(text).render_exact()
    assert np.abs(means - 0.5).max() <= bounds.max() < 1e-9


def test_a_crop_is_a_part_of_the_picture(scene: pinhole.Scene) -> None:
    x, y, width, height = CROP
    part = np.s_[y : y + height, x : x + width]
    np.testing.assert_array_equal(scene.render(crop=CROP), scene.render()[part])
    np.testing.assert_array_equal(scene.render_linear(crop=CROP), scene.render_linear()[part])
    means, bounds = scene.render_exact(crop=CROP)
    whole = scene.render_exact()
    np.testing.assert_array_equal(means, whole[0][part])
    np.testing.assert_array_equal(bounds, whole[1][part])


def test_an_array_belongs_to_its_caller(scene: pinhole.Scene) -> None:
    picture = scene.render()
    picture[:] = 7
    assert (scene.render() != 7).any()


def test_a_picture_is_loaded_as_the_scene_that_it_carries(
    scene: pinhole.Scene, tmp_path: Path
) -> None:
    rolled = pinhole.Scene(TEXT, set={"camera.roll": "8deg"})
    rolled.save(tmp_path / "a.png")
    again = pinhole.load(tmp_path / "a.png", set={"h": 1.5})
    assert (again.text, again.set) == (TEXT, ("camera.roll=8deg", "h=1.5"))
    Image.fromarray(scene.render()).save(tmp_path / "b.png")
    with pytest.raises(ValueError, match=r"b\.png: the picture carries no scene"):
        pinhole.load(tmp_path / "b.png")


def test_a_long_scene_is_not_carried_with_a_warning(tmp_path: Path) -> None:
    text = TEXT + "// and so on\n" * 100_000
    with pytest.warns(UserWarning, match="more than 1 MiB of text"):
        pinhole.Scene(text).save(tmp_path / "a.png", crop=(0, 0, 1, 1))
    assert (tmp_path / "a.png").stat().st_size < 1000


def test_what_cannot_be_rendered_is_refused_in_words(scene: pinhole.Scene, tmp_path: Path) -> None:
    for crop in [(0, 0, 0, 1), (90, 0, 7, 1), (0, -1, 5, 5), (0, 0, 2**70, 1), (1, 2, 3)]:
        with pytest.raises(ValueError, match="crop"):
            scene.render(crop=crop)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        scene.render(crop=(0, 0, 1.5, 1))  # type: ignore[arg-type]
    for threads in (0, -1):
        with pytest.raises(ValueError, match="threads"):
            scene.render(threads=threads)
    with pytest.raises(ValueError, match=r"a picture's file ends in \.png or \.exr"):
        scene.save(tmp_path / "a.jpg")
    with pytest.raises(FileNotFoundError, match="cannot write to"):
        scene.save(tmp_path / "no" / "a.png")
    with pytest.raises(FileNotFoundError):
        pinhole.load(tmp_path / "b.scn")


@pytest.mark.parametrize(("ending", "height"), [("png", 8000), ("exr", 2000)])
def test_a_picture_is_saved_in_less_memory_than_it_has(
    python: Callable[[str], "subprocess.Popen[str]"], tmp_path: Path, ending: str, height: int
) -> None:
    # The picture shows only background. Its pixels would need 288 MB, whether they are bytes in the
    # PNG or floats in the lower EXR.
    script = python(f"""
import pinhole
size = {{"image.width": 12000, "image.height": {height}, "sampler.per_pixel": 1}}
scene = pinhole.Scene("camera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}", set=size)
scene.save("a.{ending}")
print(next(line for line in open("/proc/self/status") if line.startswith("VmHWM")))
""")
    output, _ = script.communicate(timeout=120)
    assert script.returncode == 0 and int(output.split()[1]) < 200_000
    assert (tmp_path / f"a.{ending}").stat().st_size > 10_000


def test_a_picture_without_enough_memory_for_it() -> None:
    huge = pinhole.Scene(TEXT, set={"image.width": 2**20, "image.height": 2**20})
    words = r"a picture of 1048576 × 1048576 pixels needs 3\.0 TiB of memory"
    for render in (huge.render, lambda: huge.save("a.png"), huge._repr_png_):
        with pytest.raises(MemoryError, match=words):
            render()
    with pytest.raises(MemoryError, match=r"needs 24\.0 TiB of memory"):
        huge.render_exact()
    assert huge.render(crop=(2**20 - 1, 2**20 - 1, 1, 1)).shape == (1, 1, 3)
