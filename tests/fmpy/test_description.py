"""What an importer reads before it runs anything."""

import zipfile

import fmpy
from fmpy.validation import validate_fmu


def test_fmpy_finds_nothing_to_complain_about(fmu_path):
    assert validate_fmu(fmu_path) == []


def test_platform_and_interface(fmu_path, description):
    assert fmpy.platform in fmpy.supported_platforms(fmu_path)
    assert description.fmiVersion == "2.0"
    assert description.modelExchange is None
    assert description.coSimulation.modelIdentifier == "CoilWinding"
    assert description.coSimulation.canHandleVariableCommunicationStepSize
    assert description.variableNamingConvention == "structured"


def test_reals_carry_units_and_parameters_start_values(description):
    for variable in description.modelVariables:
        if variable.type == "Real":
            assert variable.unit, variable.name
        if variable.causality in ("parameter", "input"):
            assert variable.start is not None, variable.name


def test_reals_have_a_type_that_names_their_quantity(description):
    types = {t.name: t for t in description.typeDefinitions}
    for variable in description.modelVariables:
        if variable.type == "Real":
            declared = variable.declaredType
            assert types[declared.name].unit == variable.unit, variable.name
            assert declared.quantity == declared.name
    shape = next(v for v in description.modelVariables if v.name == "core.shape")
    assert shape.description.endswith("(one of rounded-box, cylinder, mesh)")


def test_every_output_is_in_the_structure(description):
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]
    assert [u.variable.name for u in description.outputs] == outputs
    assert [u.variable.name for u in description.initialUnknowns] == outputs


def test_packed_scenes_are_in_the_archive(fmu_path):
    with zipfile.ZipFile(fmu_path) as archive:
        assert "resources/scenes/fig8.toml" in archive.namelist()
