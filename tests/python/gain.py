"""A package that pythonfmu builds: an output is a parameter, inputs are shown as they were during the last step. For signs, units and start values."""

from xml.etree.ElementTree import SubElement

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

UNITS = {"mm": {"m": "1", "factor": "0.001"}, "m": {"m": "1"}, "degC": {"K": "1", "offset": "273.15"}, "K": {"K": "1"}}
VARIABLES = {
    "length": ("mm", Fmi2Causality.parameter),
    "out.x": ("mm", Fmi2Causality.output),
    "out.z": ("mm", Fmi2Causality.output),
    "out.warm": ("degC", Fmi2Causality.output),
    "in.x": ("m", Fmi2Causality.input),
    "in.z": ("m", Fmi2Causality.input),
    "in.warm": ("K", Fmi2Causality.input),
    "seen.x": ("m", Fmi2Causality.output),
    "seen.z": ("m", Fmi2Causality.output),
    "seen.warm": ("K", Fmi2Causality.output),
}


class Gain(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.values = dict.fromkeys(VARIABLES, 0.0) | {"length": 1.0, "out.warm": 20.0}
        for name, (_, causality) in VARIABLES.items():
            get, put = lambda name=name: self.get(name), lambda value, name=name: self.values.__setitem__(name, value)
            output = causality == Fmi2Causality.output
            more = {"variability": Fmi2Variability.fixed} if causality == Fmi2Causality.parameter else {}
            start = {} if output else {"start": self.values[name], "setter": put}
            self.register_variable(Real(name, causality=causality, getter=get, **start, **more))

    def get(self, name):
        return self.values["length" if name in ("out.x", "out.z") else name]

    def to_xml(self, *arguments, **options):
        """The model description with units."""
        root = super().to_xml(*arguments, **options)
        definitions = root.makeelement("UnitDefinitions", {})
        for name, base in UNITS.items():
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", base)
        root.insert(1, definitions)
        for variable in root.iter("ScalarVariable"):
            variable.find("Real").set("unit", VARIABLES[variable.get("name")][0])
        return root

    def do_step(self, current_time, step_size):
        for name in ("x", "z", "warm"):
            self.values[f"seen.{name}"] = self.values[f"in.{name}"]
        return True
