"""What masters do that know nothing about winding: simulate only, write every start value, bring a mesh along."""

import math
import shutil

import fmpy
import numpy as np
from conftest import WARNING, Slave


def test_an_importer_that_only_simulates_sees_a_coil(fmu_path, description):
    result = fmpy.simulate_fmu(fmu_path, output=["turns_wound", "spindle_angle", "defect_code"])
    assert result["time"][-1] == float(description.defaultExperiment.stopTime)
    assert result["turns_wound"][-1] > 2.0
    assert np.all(np.diff(result["spindle_angle"]) > -1e-12)


def test_setting_an_input_ends_the_demonstration(slave):
    slave.start()
    assert "demonstrates" in slave.reason()
    slave.fmu.doStep(0.0, 0.01)
    angle = slave.get("spindle_angle")
    assert angle > 0.1
    slave.set(spindle_speed=0.0)
    slave.fmu.doStep(0.01, 0.01)
    # the time that a step reached beyond the point is solved again, which rounds otherwise
    assert abs(slave.get("spindle_angle") - angle) < 1e-15


def test_an_importer_that_writes_every_start_value_is_told(slave):
    slave.fmu.setupExperiment()
    for variable in slave.description.modelVariables:
        if variable.causality == "parameter" and variable.name != "scene.file":
            start = {"Real": float, "Integer": int, "Boolean": lambda x: x == "true", "String": str}[variable.type]
            slave.set(**{variable.name.replace(".", "__"): start(variable.start)})
    slave.set(scene__file="fig8_gap")
    slave.fmu.enterInitializationMode()
    slave.fmu.exitInitializationMode()
    told = [entry[3] for entry in slave.log if entry[1] == WARNING]
    assert any("wire.material = copper was set" in text and "fig8_gap has table1" in text for text in told), told
    slave.fmu.doStep(0.0, 1e-3)
    assert slave.get("spindle_angle") == 0.0


def test_a_mesh_lies_among_the_resources(fmu_path, description, tmp_path, monkeypatch):
    directory = tmp_path / "unpacked"
    fmpy.extract(fmu_path, str(directory))
    (directory / "resources" / "bar.stl").write_text(bar(12.0, 30.0, 30.0), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    slave = Slave(str(directory), description)
    slave.start(core__shape="mesh", core__file="bar.stl", core__unit="mm")
    assert slave.get("core.file") == b"bar.stl"
    slave.set(spindle_speed=20.0)
    slave.fmu.doStep(0.0, 1e-3)
    assert math.isfinite(slave.get("wire_tension"))
    slave.free()
    shutil.rmtree(directory, ignore_errors=True)


def bar(x, y, z):
    """A box as STL; lengths along the axes."""
    def corner(k):
        return ((k & 1) - 0.5) * x, ((k >> 1 & 1) - 0.5) * y, ((k >> 2 & 1) - 0.5) * z

    faces = ["0264", "1573", "0451", "2376", "0132", "4675"]
    lines = ["solid bar"]
    for face in faces:
        a, b, c, d = (corner(int(k)) for k in face)
        for triangle in ((a, c, b), (a, d, c)):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex %g %g %g" % point for point in triangle]
            lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid bar", ""])
