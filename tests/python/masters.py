"""Runs a system of connected packages in a master, each in a process of its own.

Usage: masters.py MASTER SYSTEM.json     prints the watched values after the run as JSON, in its last line

A system has instances with their packages, connections between their variables, variables to watch, step and steps.
"""

import ctypes
import json
import sys
import tempfile
from pathlib import Path
from xml.sax.saxutils import quoteattr


def variables(system):
    from fmpy import read_model_description

    return {
        name: {v.name: v for v in read_model_description(package).modelVariables}
        for name, package in system["instances"].items()
    }


def fmpy(system):
    """A loop of its own: all instances step with what the others had at the start."""
    from conftest import Slave

    directory = Path(tempfile.mkdtemp())
    slaves = {name: Slave(package, directory / name, name) for name, package in system["instances"].items()}
    for slave in slaves.values():
        slave.start()
    for k in range(system["steps"]):
        moved = [(to, variable, slaves[source].get(output)[0]) for source, output, to, variable in system["connections"]]
        for to, variable, value in moved:
            slaves[to].set(**{variable.replace(".", "__"): value})
        for slave in slaves.values():
            slave.fmu.doStep(k * system["step"], system["step"])
    return [slaves[name].get(variable)[0] for name, variable in system["watched"]]


def libcosim(system):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    of = variables(system)
    execution = CosimExecution.from_step_size(round(system["step"] * 1e9))
    index = {
        name: execution.add_local_slave(CosimLocalSlave(fmu_path=package, instance_name=name))
        for name, package in system["instances"].items()
    }
    for source, output, to, variable in system["connections"]:
        references = [of[source][output].valueReference, of[to][variable].valueReference]
        # Zero is success.
        assert execution.connect_real_variables(index[source], references[0], index[to], references[1]) == 0
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.step(system["steps"])
    watched = [(index[name], [of[name][variable].valueReference]) for name, variable in system["watched"]]
    return [observer.last_real_values(slave, reference)[0] for slave, reference in watched]


def ecos(system):
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        for name, package in system["instances"].items():
            structure.add_model(name, package)
        for source, output, to, variable in system["connections"]:
            structure.make_real_connection(f"{source}::{output}", f"{to}::{variable}")
        with EcosSimulation(structure=structure, step_size=system["step"]) as simulation:
            simulation.init()
            simulation.step(system["steps"])
            values = [simulation.get_real(f"{name}::{variable}") for name, variable in system["watched"]]
            simulation.terminate()
    return values


def ssp(system):
    """FMPy's simulation of an SSP file, whose connectors all start at zero."""
    import zipfile

    from fmpy.ssp.simulation import simulate_ssp

    inputs = {(to, variable) for _, _, to, variable in system["connections"]}
    outputs = {(source, output) for source, output, _, _ in system["connections"]}
    outputs |= {tuple(watched) for watched in system["watched"]}
    connector = "<ssd:Connector name={} kind={}><ssc:Real/></ssd:Connector>".format

    def component(name):
        kinds = [("input", inputs), ("output", outputs)]
        connectors = [
            connector(quoteattr(variable), quoteattr(kind))
            for kind, listed in kinds
            for of, variable in sorted(listed)
            if of == name
        ]
        source = f"resources/{name}.fmu"
        return (
            f"<ssd:Component name={quoteattr(name)} type='application/x-fmu-sharedlibrary' source={quoteattr(source)}>"
            f"<ssd:Connectors>{''.join(connectors)}</ssd:Connectors></ssd:Component>"
        )

    connection = "<ssd:Connection startElement={} startConnector={} endElement={} endConnector={}/>".format
    connections = [
        connection(*map(quoteattr, four)) for four in system["connections"]
    ]
    text = (
        "<?xml version='1.0' encoding='UTF-8'?><ssd:SystemStructureDescription version='1.0' name='pair'"
        " xmlns:ssd='http://ssp-standard.org/SSP1/SystemStructureDescription'"
        " xmlns:ssc='http://ssp-standard.org/SSP1/SystemStructureCommon'><ssd:System name='system'>"
        f"<ssd:Elements>{''.join(map(component, system['instances']))}</ssd:Elements>"
        f"<ssd:Connections>{''.join(connections)}</ssd:Connections></ssd:System></ssd:SystemStructureDescription>"
    )
    file = Path(tempfile.mkdtemp()) / "pair.ssp"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("SystemStructure.ssd", text)
        for name, package in system["instances"].items():
            archive.write(package, f"resources/{name}.fmu")
    stop = system["step"] * system["steps"]
    result = simulate_ssp(str(file), start_time=0.0, stop_time=stop, step_size=system["step"])
    return [float(result[f"{name}.{variable}"][-1]) for name, variable in system["watched"]]


def fmucontainer(system):
    """One package of all, made by the FMU Manipulation Toolbox, and stepped in FMPy."""
    import shutil

    from conftest import Slave
    from fmu_manipulation_toolbox.assembly import Assembly

    directory = Path(tempfile.mkdtemp())
    for name, package in system["instances"].items():
        shutil.copy(package, directory / f"{name}.fmu")
    file = directory / "system.json"
    described = {
        "name": "system.fmu",
        "fmu": [f"{name}.fmu" for name in system["instances"]],
        "link": [[f"{source}.fmu", output, f"{to}.fmu", variable] for source, output, to, variable in system["connections"]],
        "output": [[f"{name}.fmu", variable, f"watched.{k}"] for k, (name, variable) in enumerate(system["watched"])],
        "auto_link": False,
        "auto_input": False,
        "auto_output": False,
        "step_size": system["step"],
    }
    file.write_text(json.dumps(described))
    Assembly(file.name, fmu_directory=directory).make_fmu()
    container = Slave(str(directory / "system.fmu"), directory / "unzipped", "system").start()
    for k in range(system["steps"]):
        container.fmu.doStep(k * system["step"], system["step"])
    return container.get(*[f"watched.{k}" for k in range(len(system["watched"]))])


def cofmupy(system):
    from cofmupy import Coordinator

    config = {
        # Inputs that are not given start at zero.
        "fmus": [
            {"id": name, "path": package, "initialization": system["start"].get(name, {})}
            for name, package in system["instances"].items()
        ],
        "connections": [
            {"source": {"id": source, "variable": output}, "target": {"id": to, "variable": variable}}
            for source, output, to, variable in system["connections"]
        ],
        "cosim_method": "jacobi",
        "iterative": False,
        "edge_sep": " -> ",
        "root": "",
    }
    coordinator = Coordinator()
    coordinator.start(config)
    for _ in range(system["steps"]):
        coordinator.do_step(system["step"])
    return [coordinator.get_variable((name, variable))[0] for name, variable in system["watched"]]


if __name__ == "__main__":
    master, file = sys.argv[1:]
    print()
    print(json.dumps(globals()[master](json.loads(Path(file).read_text()))))
