"""Runs what `roulement system` wrote in a master, in a process of its own.

Usage: written_system.py ecos|libcosim FOLDER NAME STEP STEPS COMPONENT.VARIABLE ...    prints the values after the run as JSON, in its last line
"""

import ctypes
import json
import re
import sys
from pathlib import Path


def ecos(folder, name, step, steps, watched):
    ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=f"{folder}/{name}.ssp", step_size=step) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(steps)
        values = [simulation.get_real(f"{component}::{variable}") for component, variable in watched]
        simulation.terminate()
    return values


def libcosim(folder, name, step, steps, watched):
    from fmpy import read_model_description
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    execution, observer = CosimExecution.from_osp_config_file(f"{folder}/{name}-osp"), CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.step(steps)
    structure = Path(f"{folder}/{name}-osp/OspSystemStructure.xml").read_text()
    values = []
    for component, variable in watched:
        # Components may share a package.
        (source,) = re.findall(f'<Simulator name="{component}" source="([^"]*)"', structure)
        variables = read_model_description(f"{folder}/{name}-osp/{source}").modelVariables
        (reference,) = (v.valueReference for v in variables if v.name == variable)
        index = execution.slave_index_from_instance_name(component)
        values += observer.last_real_values(index, [reference])
    return values


if __name__ == "__main__":
    master, folder, name, step, steps, *watched = sys.argv[1:]
    watched = [variable.split(".", 1) for variable in watched]
    values = globals()[master](folder, name, float(step), int(steps), watched)
    print()
    print(json.dumps(values))
