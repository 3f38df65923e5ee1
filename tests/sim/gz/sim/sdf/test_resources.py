"""The search for models, meshes and worlds, and the messages if they are not found."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import ResourceError, SdfError
from gz_course.sim.gz.sim.sdf.resources import (
    BUILT_IN_MODELS,
    find_file,
    find_model,
    find_world,
    package_shares,
    read_text,
    resource_paths,
)

FUEL = "https://fuel.gazebosim.org/1.0"


@pytest.fixture(autouse=True)
def _no_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("GZ_SIM_RESOURCE_PATH", "SDF_PATH", "IGN_GAZEBO_RESOURCE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(name, raising=False)


def shelf(folder: Path, name: str, *versions: str) -> Path:
    """Make a model folder whose model.config names one file for each version."""
    (folder / name / "meshes").mkdir(parents=True)
    (folder / name / "meshes" / "a b.obj").touch()
    lines = "".join(f"<sdf version='{version}'>v{version}.sdf</sdf>" for version in versions)
    (folder / name / "model.config").write_text(f"<?xml version='1.0'?><model>{lines}</model>")
    for version in versions:
        (folder / name / f"v{version}.sdf").touch()
    return folder / name


def test_the_folders_of_all_three_variables_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IGN_GAZEBO_RESOURCE_PATH", "/c:/a")
    monkeypatch.setenv("SDF_PATH", "/b")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", "/a::/d")
    assert resource_paths() == [Path(each) for each in ("/a", "/d", "/b", "/c")]
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/x:/y")
    assert package_shares() == [Path("/x/share"), Path("/y/share")]


@pytest.mark.parametrize("variable", ["GZ_SIM_RESOURCE_PATH", "SDF_PATH", "IGN_GAZEBO_RESOURCE_PATH"])
def test_a_model_on_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    shelf(tmp_path, "cart", "1.6", "1.10", "1.9")
    monkeypatch.setenv(variable, str(tmp_path))
    assert find_model("model://cart", None).name == "v1.10.sdf"
    assert find_model("model://cart/v1.6.sdf", None).name == "v1.6.sdf"
    assert find_model("package://cart", None).name == "v1.10.sdf"
    assert find_file("model://cart/meshes/a%20b.obj", None).name == "a b.obj"


def test_a_version_newer_than_all_known_is_not_chosen(tmp_path: Path) -> None:
    assert find_model(str(shelf(tmp_path, "a", "1.7", "1.99", "1.8")), None).name == "v1.8.sdf"
    assert find_model(str(shelf(tmp_path, "b", "2.0")), None).name == "v2.0.sdf"
    (shelf(tmp_path, "c", "1.7", "1.9") / "v1.9.sdf").unlink()
    assert find_model(str(tmp_path / "c"), None).name == "v1.7.sdf"


def test_paths_relative_to_the_file_that_names_them(tmp_path: Path) -> None:
    shelf(tmp_path / "models", "cart", "1.9")
    assert find_model("cart", tmp_path / "models").name == "v1.9.sdf"
    assert find_model("../models/cart/v1.9.sdf", tmp_path / "models").name == "v1.9.sdf"
    assert find_model(f"file://{tmp_path}/models/cart", None).name == "v1.9.sdf"
    assert find_file("meshes/a b.obj", tmp_path / "models" / "cart").name == "a b.obj"
    assert find_file("file://meshes/a b.obj", tmp_path / "models" / "cart").name == "a b.obj"


def test_packages_of_an_ament_prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = shelf(tmp_path / "share", "cart_description", "1.9")
    (package / "urdf").mkdir()
    (package / "urdf" / "cart.urdf").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{tmp_path}")
    assert find_model("package://cart_description/urdf/cart.urdf", None) == package / "urdf" / "cart.urdf"
    # Gazebo converts package:// in a URDF to model://.
    assert find_file("model://cart_description/meshes/a b.obj", None) == package / "meshes" / "a b.obj"
    own = shelf(tmp_path / "own", "cart_description", "1.9")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(own.parent))
    assert find_file("package://cart_description/meshes/a b.obj", None) == package / "meshes" / "a b.obj"
    assert find_file("model://cart_description/meshes/a b.obj", None) == own / "meshes" / "a b.obj"


@pytest.mark.parametrize(
    ("uri", "name"),
    [
        (f"{FUEL}/OpenRobotics/models/Ground Plane", "ground_plane"),
        (f"{FUEL}/anybody/models/Ground%20Plane/2", "ground_plane"),
        ("https://fuel.ignitionrobotics.org/1.0/openrobotics/models/Sun/tip", "sun"),
        ("https://app.gazebosim.org/OpenRobotics/fuel/models/Sun", "sun"),
        ("model://sun", "sun"),
        ("model://Ground Plane", "ground_plane"),
        ("ground_plane", "ground_plane"),
    ],
)
def test_ground_planes_and_suns_of_any_owner_are_built_in(uri: str, name: str) -> None:
    assert find_model(uri, None) == BUILT_IN_MODELS / name / "model.sdf"


def test_other_models_of_fuel_are_taken_from_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    uri = f"{FUEL}/OpenRobotics/models/Table"
    with pytest.raises(
        ResourceError, match=r"on Gazebo Fuel, and nothing is downloaded.*save the model as folder 'Table'"
    ):
        find_model(uri, None)
    table = shelf(tmp_path, "Table", "1.9")
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    assert find_model(uri, None) == table / "v1.9.sdf"
    assert find_file(f"{uri}/3/files/meshes/a b.obj", None) == table / "meshes" / "a b.obj"
    with pytest.raises(ResourceError, match="would have to be downloaded"):
        find_file(f"{FUEL}/O/models/Chair/3/files/meshes/c.obj", None)


def test_what_is_not_there_names_what_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cart = shelf(tmp_path, "cart", "1.9")
    with pytest.raises(ResourceError, match=f"there is {cart}: add {tmp_path} to GZ_SIM_RESOURCE_PATH"):
        find_file("model://cart/meshes/a b.obj", cart)
    with pytest.raises(ResourceError, match=f"there is {cart}: add {tmp_path} to GZ_SIM_RESOURCE_PATH"):
        find_model("model://cart", tmp_path)
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path))
    with pytest.raises(ResourceError, match=r"'model://cart/meshes/ab\.obj' was not found; did you mean 'a b\.obj'"):
        find_file("model://cart/meshes/ab.obj", None)
    with pytest.raises(ResourceError, match="did you mean 'cart'"):
        find_model("model://crt", None)
    (cart / "model.config").unlink()
    with pytest.raises(ResourceError, match=r"has neither model\.config nor model\.sdf"):
        find_model("model://cart", None)


def test_a_broken_model_config_names_its_line(tmp_path: Path) -> None:
    cart = shelf(tmp_path, "cart", "1.9")
    (cart / "model.config").write_text("<model>\n<sdf version='1.9'>v1.9.sdf</model>")
    with pytest.raises(SdfError, match=r"model\.config:2: this is not well-formed XML"):
        find_model(str(cart), None)


def test_a_built_in_world_is_named_without_a_folder(tmp_path: Path) -> None:
    with pytest.raises(ResourceError, match=r"built-in worlds; shapes\.sdf, without a folder, is found$"):
        find_world(str(tmp_path / "shapes.sdf"))
    with pytest.raises(ResourceError, match=r"; did you mean 'shapes\.sdf'\?$"):
        find_world("shape.sdf")


def test_a_world_is_not_downloaded_and_a_huge_one_not_read(tmp_path: Path) -> None:
    with pytest.raises(ResourceError, match="would have to be downloaded"):
        find_world("https://fuel.gazebosim.org/1.0/OpenRobotics/worlds/Empty")
    with (tmp_path / "w.sdf").open("wb") as file:
        file.truncate(100 * 2**20)
    with pytest.raises(SdfError, match="larger than 64 MiB"):
        read_text(tmp_path / "w.sdf")
    with pytest.raises(SdfError, match="cannot be read"):
        read_text(tmp_path)


@settings(deadline=None, max_examples=200)
@given(
    st.text(max_size=40)
    | st.builds("{}://{}".format, st.sampled_from(["model", "file", "https", "package"]), st.text())
)
def test_any_uri_is_found_or_refused_with_a_sentence(uri: str) -> None:
    for find in (find_model, find_file):
        try:
            assert find(uri, None).exists()
        except SdfError as error:
            assert str(error)


def test_a_model_behind_file_is_named_as_a_model(tmp_path, monkeypatch):
    (tmp_path / "models" / "arm").mkdir(parents=True)
    (tmp_path / "models" / "arm" / "arm.stl").touch()
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
    with pytest.raises(ResourceError, match=r"did you mean 'model://arm/arm\.stl'\?"):
        find_file("file://models/arm/arm.stl", tmp_path / "worlds")
