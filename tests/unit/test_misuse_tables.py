"""Frequent mistakes of users: each row is refused with a message that names the wrong argument.

A row is a call and the required words of its message. Calls in Python are texts, so that a failure
names its row; command lines are written as typed. Junk in single arguments is tested in
`test_misuse.py`, suggestions of names in `test_messages.py`.
"""

import json
import shlex
import shutil
import warnings
from inspect import getattr_static, isclass, signature
from pathlib import Path
from types import FunctionType, ModuleType

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import rockframe as rf
from rockframe.command.files.templates import TEMPLATES
from rockframe.command.main import main
from rockframe.errors import AccessError, ArgumentError, RockframeError

pytestmark = pytest.mark.unit
LIBRARIES = {"np": np, "pd": pd, "rf": rf, "xr": xr}
"""What rows are written with, beside what stands below."""

BLOCK = rf.Block(width="0.8 m", height="3.2 m", mass="5.5 t")
SYSTEM = rf.System(BLOCK)
GROUND = rf.RigidGround()
PULSE = rf.GroundMotion.sine_pulse("2.5 m/s^2", "1 Hz")
RECORD = rf.GroundMotion.from_arrays(
    (3.0 * np.sin(0.1 * np.arange(200)), "m/s^2"), "0.01 s", name="record"
)
OTHER = RECORD.scaled(1.3)
SUITE = rf.MotionSuite({"first": RECORD, "second": OTHER})
PAIR = rf.HorizontalPair(RECORD, OTHER)
TARGET = rf.TargetSpectrum.eurocode_8("0.3 g_0")
STACK = rf.Stack(BLOCK, BLOCK, interfaces=[GROUND])
FRAME = rf.RockingFrame(BLOCK, columns=2, beam_mass="1 t")
COUNTS = {"intensity": ([0.2, 0.4, 0.8], "m/s"), "exceeded": [1, 6, 19], "trials": 20}
FRAGILITY = rf.fragility(COUNTS, "PGV")
HAZARD = {"intensity": ([0.2, 0.4], "m/s"), "rate": [0.01, 0.001]}
CHECK = rf.codes.asce_7_22(BLOCK, spectral_acceleration=1.0)


def block(**changed):
    return rf.Block(**{"width": "0.8 m", "height": "3.2 m", "mass": "5.5 t", **changed})


def pads(**changed):
    return rf.TwoSpringSupport(**{"frequency_ratio": 40, "damping_ratio": 0.1, **changed})


def tie(**changed):
    arguments = {"on": ("0 m", "3 m"), "to": ("1 m", "3 m"), "stiffness": "1 MN/m"}
    return rf.Restrainer(**{**arguments, **changed})


def frame(**changed):
    arguments = {"storeys": 3, "width": "4 m", "height": "9 m", "column_width": "0.25 m",
             "beam_height": "0.3 m", "beam_width": "0.25 m", "density": "2500 kg/m^3"}  # fmt: skip
    return rf.RegularFrame(**{**arguments, **changed})


def outline(*points, **changed):
    arguments = {"unit": "m", "density": "2 t/m^3", "depth": "1 m"}
    return rf.Block.from_outline(list(points), **{**arguments, **changed})


def simulate(**arguments):
    return SYSTEM.simulate(PULSE, accuracy=arguments.pop("accuracy", "fast"), **arguments)


def sweep(*motions, **arguments):
    return rf.sweep(SYSTEM, *(motions or (RECORD,)), accuracy="fast", progress=False, **arguments)


def ida(**arguments):
    return rf.incremental_dynamic_analysis(
        SYSTEM, SUITE, progress=False, accuracy="fast", **arguments
    )


def critical(*motions, **arguments):
    return rf.critical_scale(SYSTEM, *(motions or (RECORD,)), progress=False, **arguments)


def map_of(pulse=rf.GroundMotion.sine_pulse, **changed):
    arguments = {"amplitude": ([1.0, 2.0], "m/s^2"), "frequency": ([1.0], "Hz"), "progress": False}
    return rf.overturning_map(SYSTEM, pulse, **{**arguments, **changed})


def sample(**changed):
    arguments = {"spread": {"width": ("uniform", "0.7 m", "0.9 m")}, "cases": 4, "progress": False}
    return rf.probability_of_overturning(SYSTEM, RECORD, **{**arguments, **changed})


def decay(**changed):
    arguments = {"peaks": ([0.1, 0.09, 0.08, 0.07], "rad"), "accuracy": "fast"}
    return rf.fit_free_decay(SYSTEM, **{**arguments, **changed})


NAMES = {
    # misspelt names, with the suggestion
    "rf.GroudMotion": "'GroundMotion'",
    "rf.fragilty": "'fragility'",
    "rf.plot.respones": "'response'",
    "rf.plot.overturningmap": "'overturning_map'",
    "rf.codes.circolare2019": "'circolare_2019'",
    "rf.export.to_opensee": "'to_opensees'",
    "rf.measures.intensity_measure": "'intensity_measures'",
    "rf.errors.RockframError": "'RockframeError'",
    "rf.extension.OwnBas": "'OwnBase'",
    "rf.Block.from_densty": "'from_density'",
    "rf.GroundMotion.sine_puls": "'sine_pulse'",
    "rf.MotionSuite.form_dataset": "'from_dataset'",
    "rf.TargetSpectrum.eurocode8": "'eurocode_8'",
    "rf.System.from_datset": "'from_dataset'",
    "BLOCK.widht": "'width'",
    "BLOCK.repalce(width='1 m')": "'replace'",
    "STACK.bodys": "'bodies'",
    "SYSTEM.simulat(PULSE)": "'simulate'",
    "SYSTEM.gravty": "'gravity'",
    "RECORD.scale(2)": "'scaled'",
    "RECORD.resample('0.1 s')": "'resampled'",
    "RECORD.peak_aceleration": "'peak_acceleration'",
    "PAIR.rotate('30 deg')": "'rotated'",
    "SUITE.response_spectra()": "'response_spectrum'",
    "SUITE['frist']": "'first'",
    "SUITE.only(['frist'])": "'first'",
    "SUITE.select(magnitud=(6, 7))": "'magnitude'",
    "SUITE.sort('magntude')": "'magnitude'",
    "TARGET.scale(2)": "'scaled'",
    "CHECK.pased": "'passed'",
    "CHECK.value('M_TO')": "'M_OT'",
    "run.rockframe.polt()": "'plot'",
    "run.rockframe.table('event')": "'events'",
    "block(heigth='1 m')": "'height'",
    "BLOCK.replace(widht='1 m')": "'width'",
    "STACK.replace(body=BLOCK)": "'bodies'",
    "rf.Block.from_dict(argument={})": "'arguments'",
    "rf.Block.from_dict({'widht': '1 m', 'height': '4 m', 'mass': '1 t'})": "'width'",
    "BLOCK.with_si(value={})": "'values'",
    "BLOCK.with_si({'widht': 1.0})": "'width'",
    "BLOCK.with_scaled('widht', 2.0)": "'width'",
    "BLOCK.with_scaled('width', facter=2.0)": "'factor'",
    "FRAME.with_scaled('beammass', 2.0)": "'beam_mass'",
    "BLOCK.left_behind(['widht'])": "'width'",
    "BLOCK.left_behind(change=['width'])": "'changed'",
    "rf.Accuracy(rtl=1e-6)": "'rtol'",
    "rf.RigidGround(mu=0.3)": "'friction'",
    "rf.sweep(SYSTEM, PULSE, pga=['2 m/s^2'])": "'peak_ground_acceleration'",
    "PULSE.pga": "'peak_acceleration'",
    "rf.IDA": "'incremental_dynamic_analysis'",
    "rf.Certification(nuge=0.1)": "'nudge'",
    "rf.extension.Ratio(docs='x')": "'doc'",
    "rf.System.from_dict(descripton={})": "'description'",
    "rf.System.from_dict({**SYSTEM.to_dict(), 'restrain': 'centre'})": "'restraint'",
    "rf.System.from_dict({'parts': [{'type': 'Blok'}]})": "'Block'",
    "rf.System(BLOCK, restraint='corner')": "'leading-corner'",
    "simulate(acuracy='fast')": "'accuracy'",
    "simulate(accuracy='fsat')": "'fast'",
    "simulate(outputs=['acelerations'])": "'acceleration'",
    "rf.GroundMotion.from_dict({'constructor': 'sine_puls'})": "'sine_pulse'",
    "rf.GroundMotion.from_frame(pd.DataFrame({'acc': [1.0], 'x': [1.0]}), 'g', 'ac')": "'acc'",
    "rf.GroundMotion.example('loma-preta')": "'loma-prieta'",
    "rf.GroundMotion.read('nums.txt', format='peer-at')": "'peer-at2'",
    "sweep(scal=[1])": "'scale'",
    "sweep(widht=['1 m'])": "'width'",
    "rf.case(runs, scal=1, motion='first')": "'scale'",
    "rf.open_study('store', lasy=True)": "'lazy'",
    "rf.fragility(runs, 'peak_ground_acc')": "'peak_ground_acceleration'",
    "rf.fragility(runs, limits=['uplfit'])": "'uplift'",
    "rf.fragility(runs, limits=[('peak_slp', '5 cm')])": "'peak_slip'",
    "rf.fragility(runs, bands='jacknife')": "'jackknife'",
    "rf.ensemble_statistics(runs, 'peak_rotaton')": "'peak_rotation'",
    "rf.cloud_analysis(runs, response='peak_rotaton')": "'peak_rotation'",
    "rf.tradeoff(SYSTEM, PULSE, models=['rigid grund'])": "'rigid ground'",
    "rf.table(run, units={'angel': 'deg'})": "'angle'",
    "rf.report(run, 'x.html', project={'objekt': 'x'}, certify=False)": "'object'",
    "rf.plot.response(run, panels=['rotations'])": "'rotation'",
    "rf.plot.sweep(runs, 'peak_rotaton')": "'peak_rotation'",
    "rf.fit_free_decay(SYSTEM, peaks=([0.1], 'rad'), parameters='restituton')": "'restitution'",
    "rf.codes.circolare_2019(SYSTEM, TARGET, limit_state='SLVV')": "'SLV'",
    "rf.export.to_openquake({'a': FRAGILITY}, 'x.xml', loss='content')": "'contents'",
}

VALUES = {
    "simulate(outputs={'acceleration': False})": "outputs has no {'acceleration': False}",
    "simulate(accuracy='faast')": "simulate: accuracy must be one of",
    "sweep(store='')": "store must be the path of a folder, got ''",
    r"sweep(store='a\0b')": r"store must be the path of a folder, got 'a\x00b'",
    # parts
    "block(width=0.8)": "width needs a length with a unit, got 0.8",
    "rf.TwoSpringSupport(friction=0.3)": "neither was given; rigid contact with friction",
    "block(width='0.8 s')": "width needs a length in a unit such as m, got '0.8 s'",
    "rf.Load(at=('0 m', 3), vertical='1 kN')": "Load: at[1] needs a length with a unit, got 3",
    "block(width='0.8 metr')": "'0.8 metr', whose unit cannot be read",
    "block(width='0,8 m')": "a decimal point",
    "block(width='-0.8 m')": "width must be greater than zero, got '-0.8 m'",
    "block(height='nan m')": "height must be finite, got 'nan m'",
    "block(height='inf m')": "height must be finite",
    "block(height=(10**400, 'm'))": "height must be finite",
    "block(width=np.array([1.0, 2.0]))": "width needs a length with a unit, got array",
    "block(width=1 + 2j)": "(1+2j)",
    "block(width=True)": "width needs a length with a unit, got True",
    "block(width=None)": "width needs a length with a unit, got None",
    "block(width=BLOCK)": "a Block has no unit",
    "block(mass='5.5 kN')": "a force is no mass",
    "block(mass='5500')": "no unit",
    "rf.Block('1 m', '4 m', '5 t')": "takes 1 positional argument but 4 were given. It takes width",
    "rf.Block(width='1 m', height='4 m')": "missing 1 required keyword-only argument: 'mass'",
    "block(density='2 t/m^3')": "'density', which Block.from_density",
    "block(shape_factor=0.3, inertia='10 t*m^2')": "give shape_factor or inertia, not both",
    "block(shape_factor='0.3 m')": "shape_factor needs a pure ratio, got '0.3 m'",
    "block(shape_factor=[0.3])": "[0.3]",
    "block(centre_of_mass='1 m')": "centre_of_mass needs two lengths",
    "block(centre_of_mass=('1 m', '5 m'))": "centre of mass",
    "rf.Block.cylinder(radius='1 m', height='4 m', mass='1 t')": "'radius'. It takes diameter",
    "rf.Block.cylinder(diameter='1 m', height='4 m')": "give mass or density; neither",
    "rf.Block.from_density(width='1 m', height='4 m', density='2 t/m^3')": "'depth'",
    "rf.Block.from_size(radius='2 m', slenderness='4 m', mass='1 t')": "slenderness",
    "outline((0, 0), (1, 0))": "three different points or more, got 2",
    "outline((0, 0), (1, 2), (1, 0), (0, 2))": "crosses or touches itself",
    "outline((0, 0), (1, 0), (1, 2), unit='s')": "points",
    "rf.Block.from_parts([BLOCK])": "a mapping from names to parts",
    "rf.Block.from_dict(None)": "Block.from_dict: description must be a mapping",
    "rf.Block.from_dict(GROUND.to_dict())": "'RigidGround'",
    "BLOCK.with_si(3)": "Block.with_si: values must be a mapping",
    "BLOCK.with_si({'width': [1.0]})": "Block: width",
    "BLOCK.with_si({'width': True})": "Block: width",
    "BLOCK.with_si({'slenderness': 'x'})": "slenderness needs a pure ratio, got 'x'",
    "BLOCK.with_si({'radius': [1.0]})": "radius needs a length",
    "FRAME.with_si({'columns': 2.5})": "columns must be a whole number from 1 on, got 2.5",
    "tie().with_si({'brittle': 1.0})": "brittle must be True or False, got 1.0",
    "tie().with_si({'name': 3.0})": "name must be a text",
    "tie().with_si({'on': 1.0})": "on must be a point",
    "GROUND.with_si({'impact': 1.0})": "impact must be 'coulomb' or 'stick', got 1.0",
    "BLOCK.with_scaled('width', 'x')": "factor needs a pure ratio, got 'x'",
    "BLOCK.with_scaled('width', None)": "factor",
    "BLOCK.with_scaled('width', -1.0)": "width must be greater than zero",
    "BLOCK.left_behind(3)": "changed must be a list of names, got 3",
    "setattr(BLOCK, 'width', '2 m')": "Block is immutable",
    "rf.TwoSpringSupport()": "give frequency_ratio or stiffness; neither",
    "pads(stiffness='12 MN/m')": "both were given",
    "pads(frequency_ratio='40 Hz')": "frequency_ratio needs a pure ratio, got '40 Hz'",
    "pads(damping_ratio=-0.1)": "damping_ratio must be zero or more",
    "pads(restitution=2)": "restitution must be above 0 and at most 1",
    "pads(friction=0.3, kinetic_friction=0.5)": "kinetic_friction must be at most",
    "rf.RigidGround(impact='newtonian')": "impact must be 'coulomb' or 'stick', got 'newtonian'",
    "rf.RigidGround('0.9')": "takes 1 positional argument but 2 were given. It takes restitution",
    "rf.WinklerSoil(stiffness='20 MN/m^3', damping_ratio=0.2)": "from_subgrade_modulus",
    "rf.WinklerSoil(stiffness='9 MPa', damping_ratio=0.1, separation='x')": "separation",
    "rf.CushionCap(height='1 m', mass='1 t', density='2 t/m^3')": "give mass or density",
    "rf.FrameEquivalent(width='4 m', height='18 m', mass='99 t')": "shape_factor or inertia",
    "frame(storeys=2.5)": "storeys must be a whole number",
    "frame(storey_heights=3)": "storey_heights",
    "rf.Member(name='a', mass='1 t', x='0 m', y='1 m')": "give width and height, or inertia",
    "rf.InitialState(rotation=0.1)": "rotation needs an angle with a unit, got 0.1",
    "rf.Load(at='1 m', vertical='1 kN')": "at must be a point",
    "rf.Load(at=('0 m', '1 m'), vertical='1 kN', on_body=float('nan'))": "on_body",
    "rf.System(BLOCK, rf.Load(at=('0 m', '1 m'), vertical='1 kN', on_body=7))": "no body 7",
    "tie(brittle='yes')": "brittle must be True or False, got 'yes'",
    "tie(brittle=['yes'])": "brittle must be True or False, got ['yes']",
    "tie(name=3)": "name must be a text",
    "tie(slack='1 mm', preload='1 kN')": "slack",
    "rf.RearWall(side='back')": "side must be 'left' or 'right', got 'back'",
    "rf.RearWall(restitution=0.5)": "restitution must be from -1 to 0",
    "rf.Stack(BLOCK, BLOCK)": "'interfaces'",
    "rf.Stack(BLOCK, BLOCK, interfaces=3)": "interfaces must be a list of bases",
    "rf.Stack(BLOCK, BLOCK, interfaces=[GROUND], offsets=3)": "offsets must be a list of lengths",
    "rf.Stack(BLOCK, interfaces=[])": "it has 2 to 15 bodies, got 1",
    "rf.Stack(BLOCK, GROUND, interfaces=[GROUND])": "a body of a stack is a Block",
    "rf.Stack.from_dict({'bodies': 3})": "bodies must be a list of descriptions, got 3",
    "rf.RockingFrame(BLOCK, columns='two', beam_mass='1 t')": "columns must be a whole number",
    "rf.RockingFrame(None, columns=2, beam_mass='1 t')": "column must be a Block, got None",
    "rf.Accuracy('fast')": "takes 1 positional argument",
    "rf.Accuracy(rtol=1.0)": "rtol must lie from",
    "rf.Certification(nudge='a')": "nudge needs a pure ratio, got 'a'",
    # systems
    "rf.System()": "no Block is given",
    "rf.System(rf.Block)": "it is the class itself",
    "rf.System([BLOCK, GROUND])": "is not a part of a system",
    "rf.System(BLOCK, BLOCK)": "Block is given twice",
    "rf.System(BLOCK, PULSE, PULSE)": "GroundMotion is given twice",
    "rf.System('scene.toml')": "'scene.toml' is not a part of a system",
    "rf.System(BLOCK, rf.CushionCap(height='1 m', mass='1 t'))": "without a WinklerSoil",
    "rf.System(BLOCK, block=BLOCK)": "'block'. It takes restraint",
    "rf.System(BLOCK, gravity=9.81)": "gravity needs an acceleration with a unit, got 9.81",
    "rf.System(BLOCK, inclination='45 deg')": "falls to the left by its own weight",
    "rf.System(BLOCK, sliding=True)": "sliding must be one of 'computed', 'checked', got True",
    "rf.System.from_dict(json.dumps(SYSTEM.to_dict()))": "description must be a mapping",
    "rf.System.from_dict({'part': []})": "'parts'",
    "rf.System.from_dataset('out.nc')": "'out.nc'; expected a dataset",
    "rf.System.from_dataset(run.drop_attrs())": "'system_json'",
    "rf.System.from_dataset(run.assign_attrs(system_json='{'))": "'system_json' does not describe",
    "SYSTEM.frequencies()": "rigid ground has no small motion",
    "SYSTEM.moment_rotation(0.1)": "angles needs an angle with a unit, got 0.1",
    "SYSTEM.moment_rotation(([], 'rad'))": "angles must be one or more",
    # runs
    "SYSTEM.simulate()": "nothing to simulate",
    "SYSTEM.simulate('x.AT2')": "GroundMotion.read('x.AT2')",
    "SYSTEM.simulate(SUITE)": "motion must be a GroundMotion, got <MotionSuite",
    "SYSTEM.simulate(PULSE, PULSE)": "positional arguments but 3 were given. It takes motion",
    "simulate(duration=20)": "duration needs a time with a unit, got 20",
    "simulate(duration='-1 s')": "duration must be greater than zero",
    "simulate(duration='1 s', free_vibration='1 s')": "give duration or free_vibration, not both",
    "simulate(free_vibration='1e12 s')": "the histories would have 1.28e+14 samples",
    "simulate(initial=0.1)": "initial must be an InitialState or the result of a run, got 0.1",
    "simulate(initial=PULSE.to_dataset())": "holds no end of a run",
    "simulate(initial=rf.InitialState(rotation='2 rad'))": "was '2 deg' meant?",
    "simulate(accuracy=True)": "accuracy must be one of 'fast'",
    "simulate(output_step='0 s')": "output_step must be greater than zero",
    "simulate(outputs=['toe_pressure'])": "needs a WinklerSoil",
    "simulate(points=['0 m', '3 m'])": "points must name places",
    "simulate(points={'a': (0, 3)})": "points['a'] needs a length with a unit, got 0",
    "simulate(overturning='go on')": "overturning must be one of 'stop', 'continue', got 'go on'",
    "simulate(certify='prove')": "certify must be True, False, 'proved'",
    "simulate(second_look='no')": "second_look must be True or False, got 'no'",
    "simulate(scale=2)": "simulate(motion.scaled(1.5))",
    # motions
    "rf.GroundMotion()": "it is not built by calling the class",
    "rf.GroundMotion('x.AT2')": "GroundMotion.read(path)",
    "rf.GroundMotion.from_arrays(np.zeros(5), '0.01 s')": "acceleration=(values, 'm/s^2')",
    "rf.GroundMotion.from_arrays((np.zeros(5), 'm/s'), '0.01 s')": "'m/s'",
    "rf.GroundMotion.from_arrays((np.zeros(5), 'm/s^2'), '100 Hz')": "time_step",
    "rf.GroundMotion.from_arrays(([0.0, np.nan], 'm/s^2'), '0.01 s')": "nan at index 1",
    "rf.GroundMotion.from_arrays(([0.0, 1j], 'm/s^2'), '0.01 s')": "complex128",
    "rf.GroundMotion.from_times(([0, 2, 1], 's'), ([0, 1, 0], 'm/s^2'), '0.01 s')": "increasing",
    "rf.GroundMotion.from_times(([0, 1], 's'), ([0, 1], 'm/s^2'), '0.1 s', name=3)": "name must",
    "rf.GroundMotion.from_frame(pd.DataFrame({'a': [1.0]}), 'g', ['a'])": "must name a column",
    "rf.GroundMotion.from_dict(3)": "GroundMotion.from_dict: found 3",
    "rf.GroundMotion.from_dataset('a.nc')": "'a.nc'; expected a dataset",
    "rf.GroundMotion.sine_pulse('1 Hz', '2 m/s^2')": "amplitude needs an acceleration",
    "rf.GroundMotion.sine_pulse('1 m/s^2', '6.28 rad/s')": "a cyclic frequency in Hz",
    "rf.GroundMotion.harmonic('1 m/s^2', '1 Hz')": "'duration'. It takes amplitude",
    "rf.GroundMotion.stochastic(60, '10 km', 1)": "magnitude must be from 3 to 8.5",
    "rf.GroundMotion.read('none.AT2')": "none.AT2: found no such file",
    "rf.GroundMotion.read('empty.AT2')": "an empty file",
    "rf.GroundMotion.read('kept')": "a directory",
    "rf.GroundMotion.read('noise')": "binary data",
    "rf.GroundMotion.read('nums.txt')": "no times",
    "rf.GroundMotion.read('nums.txt', unit='gal/s')": "unit needs the unit of an acceleration",
    "rf.GroundMotion.read(['a.AT2', 'b.AT2'])": "names no file",
    "rf.GroundMotion.read('nums.txt', dt='0.01 s')": "'dt'; was 'time_step' meant? It takes path",
    "RECORD.window('1 s', '0.5 s')": "end = 0.5 s must be at least one time step",
    "RECORD.window(0.5, 1)": "start needs a time with a unit, got 0.5",
    "RECORD.scaled()": "give one of factor, peak",
    "RECORD.scaled(peak=0.3)": "peak needs an acceleration with a unit, got 0.3",
    "RECORD.filtered('25 Hz', '0.1 Hz')": "low = 25 Hz must be below high",
    "RECORD.filtered('0.1 Hz', '20 Hz', causal='yes')": "causal must be True or False",
    "RECORD.rotated(3, '30 deg')": "other needs a GroundMotion",
    "RECORD.matched(3)": "target needs a TargetSpectrum, got 3",
    "RECORD.through_storeys(periods=[0.5])": "periods needs a time with a unit, got 0.5",
    "RECORD.to_at2('x.csv')": "the name ends in '.csv'",
    "RECORD.to_dict(samples='yes')": "samples must be True or False, got 'yes'",
    "setattr(RECORD, 'name', 'x')": "GroundMotion is immutable",
    "rf.HorizontalPair(RECORD)": "'second'. It takes first",
    "PAIR.rotated(30)": "angle needs an angle with a unit, got 30",
    "rf.MotionSuite(['a.AT2'])": "needs a GroundMotion, got 'a.AT2'",
    "rf.MotionSuite([])": "found no motions",
    "rf.MotionSuite(SUITE, remarks=3)": "remarks must be a list of texts, got 3",
    "SUITE.changed(3)": "step must be a function of motion, got 3",
    "SUITE.changed(lambda: 0)": "step must be a function of motion",
    "SUITE.scaled_to(None)": "target needs a TargetSpectrum, got None",
    "SUITE.scaling_to(TARGET, bounds=3)": "bounds must be a list of factors, got 3",
    "SUITE.selection_for(TARGET, 0)": "count must be a whole number, 1 or more, got 0",
    "rf.read_suite('none.zip')": "no such file or folder, 'none.zip'",
    "rf.TargetSpectrum(3, 4)": "name must be a text, got 3",
    "rf.TargetSpectrum('x', 4)": "shape must be a function of periods, got 4",
    "rf.TargetSpectrum.eurocode_8(0.3)": "ground_acceleration needs an acceleration",
    "rf.TargetSpectrum.eurocode_8('0.3 g_0', 'F')": "ground_type must be 'A'",
    "rf.TargetSpectrum.from_table(([0.2, 0.1], 's'), ([1.0, 2.0], 'm/s^2'))": "increasing",
    "rf.TargetSpectrum.from_table(([0.1, 0.2], 's'), ([1.0, 2.0], 'm/s^2'), name=3)": "name must",
    "TARGET.at(0.5)": "periods needs a time with a unit, got 0.5",
    "TARGET.at_seconds(0.5, owner='mine')": "mine: seconds must be an array of periods",
    # measures
    "rf.intensity_measures(None)": "motion needs a GroundMotion, got None",
    "rf.intensity_measures(RECORD, component='both')": "component must be 'horizontal'",
    "rf.response_spectrum(RECORD, [0.1])": "periods needs a time with a unit, got 0.1",
    "rf.response_spectrum(RECORD, damping_ratios=5)": "damping_ratios must be from 0 to 1",
    "rf.rotated_spectrum(RECORD)": "pair needs two horizontal components",
    "rf.fourier_spectrum(RECORD, resolution='0.1 s')": "a period; its frequency is '10 Hz'",
    "rf.average_spectral_acceleration(RECORD)": "'periods'. It takes motion",
    # studies
    "rf.sweep()": "'scene'. It takes scene",
    "rf.sweep(BLOCK, RECORD, scale=[1])": "mass='5500.0 kg'); write rf.System(block, ...)",
    "sweep('x.AT2', scale=[1])": "motions must be a GroundMotion, or several, got 'x.AT2'",
    "sweep(width=[1, 2])": "width needs a length with a unit, got bare numbers",
    "sweep(width=([1], 's'))": "width needs a length in a unit such as m, got '1 s'",
    "sweep(scale=[])": "axis 'scale' has no values",
    "sweep(scale=[1, 1])": "has the value 1.0 twice",
    "sweep(scale=[1], cases={'scale': [1]})": "'scale' is both an axis and a column",
    "sweep(cases='cases.csv')": "cases must be a DataFrame",
    "sweep(scale=[1], store=3)": "store must be the path of a folder, got 3",
    "sweep(scale=[1], executor=4)": "executor must be a concurrent.futures.Executor, got 4",
    "sweep(scale=[1], chunk=0)": "chunk must be a whole number",
    "sweep(scale=[1], known=3)": "known must be a list of folders, got 3",
    "sweep(scale=[1], initial='0.1 rad')": "InitialState(rotation='0.1 rad')",
    "rf.case(run)": "is no sweep",
    "rf.case(runs, motion='first')": "give a value of 'scale'",
    "rf.case(runs, scale=7, motion='first')": "scale has no 7",
    "rf.case(runs, scale=1, motion='first', scene=3)": "scene must be a System",
    "rf.case(runs, scale=1, motion='first', motions=3)": "motions must be a GroundMotion",
    "rf.case(runs, 3)": "takes 1 positional argument but 2 were given",
    "rf.open_study('none')": "none: found no study",
    "rf.open_study('kept')": "kept: found no study",
    "rf.open_study('cut')": "damaged",
    "rf.open_study(3)": "store must be the path of a folder, got 3",
    r"rf.open_study('~\0')": r"store must be the path of a folder, got '~\x00'",
    "rf.open_study('store', lazy='yes')": "lazy must be True or False, got 'yes'",
    "rf.fragility(run)": "a single run, which is no sweep",
    "rf.fragility(runs, 'SA')": "needs a period",
    "rf.fragility(runs, limits=[-0.5])": "limits must be above 0 and below 1",
    "rf.fragility(runs, limits=object())": "limits must be a list of limit states",
    "rf.fragility(runs, pooled=3)": "pooled must be a list of names, got 3",
    "rf.fragility(runs, confidence=95)": "confidence must be from 0.5 to 0.9999",
    "rf.fragility(runs, motions=3)": "motions must be a GroundMotion, or several, got 3",
    "rf.fragility({**COUNTS, 'exceeded': [1, 6, 60]}, 'PGV')": "exceedances",
    "rf.fragility(runs.drop_vars('overturned'))": "without overturned",
    "ida(scale=3)": "scale needs 2 to 100000 different numbers above zero, got 3",
    "ida(scales=[1, 2])": "'scale'",
    "ida(limits='uplft')": "'uplift'",
    "critical(BLOCK)": "motion must be a GroundMotion, got Block",
    "critical(largest=-1)": "largest must be greater than zero",
    "critical(width=4)": "'bracket_width'",
    "critical(intensity='SA')": "needs a period",
    "map_of('sine_pulse')": "pulse must be a GroundMotion or a function",
    "map_of(rf.GroundMotion.type_a_pulse)": "pulse is called with an acceleration and a frequency",
    "map_of(rf.GroundMotion.type_a_pulse('1 m/s', '1 s'))": "lambda a, f: rf.GroundMotion.ricker",
    "map_of(lambda a: PULSE)": "pulse must be a function of amplitude and frequency",
    "map_of(amplitude=[1, 2])": "amplitude needs an acceleration with a unit",
    "map_of(frequency=([1.0], 's'))": "frequency needs a cyclic frequency",
    "rf.rocking_spectrum(SYSTEM, RECORD)": "'periods'. It takes system",
    "rf.rocking_spectrum(SYSTEM, RECORD, periods=['-2 s'])": "periods must be above zero",
    "sample(spread={'width': 0.1})": "width needs ('normal', mean, standard deviation)",
    "sample(correlation='x')": "correlation must be a symmetric matrix",
    "rf.earthquake_sequences(SYSTEM, [RECORD, PULSE])": "found 2 motions in a row; expected a row",
    "rf.earthquake_sequences(SYSTEM, {'a': 3})": "'a' must be a list of GroundMotions",
    "rf.earthquake_sequences(SYSTEM, {'a': [RECORD]}, pause=20)": "pause needs a time",
    "rf.cloud_analysis(runs, 'XYZ')": "intensity must be one of",
    "rf.cloud_analysis(runs, seed='a')": "seed must be a whole number, 0 or more, got 'a'",
    "rf.compare_intensities(runs, 3)": "measures must be a list of measures, got 3",
    "rf.ensemble_statistics(runs, quantiles=0.5)": "quantiles must be a list of numbers",
    "rf.ensemble_statistics(None)": "found None; expected a dataset",
    "rf.fractile_curves(runs, fractiles=0.5)": "fractiles must be a list of numbers",
    "rf.annual_rate(FRAGILITY, 3)": "hazard must be a table, a DataArray or a function, got 3",
    "rf.annual_rate(FRAGILITY, lambda: 0, between=([0.1, 1.0], 'm/s'))": "hazard must be",
    "rf.annual_rate({}, HAZARD)": "expected a dataset",
    "rf.tradeoff(SYSTEM)": "nothing to simulate",
    "rf.tradeoff(SYSTEM, PULSE, accuracies=None)": "accuracies must be a list of accuracies",
    "rf.tradeoff(SYSTEM, PULSE, repeats=0)": "repeats must be a whole number",
    "rf.recommend(run)": "expected one of tradeoff()",
    "rf.recommend(run, error=['x'])": "error must be 'peak_error'",
    "rf.model_ladder(BLOCK)": "system needs a System, got Block; write rf.System(block, ...)",
    "rf.prove(BLOCK)": "mass='5500.0 kg'); write rf.System(block, ...)",
    "BLOCK.simulate(RECORD)": "write rf.System(block, ...).simulate(motion)",
    "rf.simulate(SYSTEM, RECORD)": "write rf.System(block, ...).simulate(motion)",
    "RECORD.plot()": "; the functions of rf.plot draw",
    "rf.fragility({})": "found none and 'PGA'",
    "rf.case({})": "runs must be the result of rf.sweep or the folder of its store, got {}",
    # results
    "rf.concat(run)": "expected a list of datasets",
    "rf.concat(['a.nc'])": "'a.nc'; expected a dataset",
    "rf.concat([run, run], 'run', ['a'])": "found 1 labels for 2 runs",
    "rf.concat([run, run], histories='yes')": "histories must be True or False, got 'yes'",
    "rf.table(run, units={'time': 'ms'})": "times stay in s",
    "rf.table(run, units={'angle': 'm'})": "units['angle'] needs an angle",
    "rf.report(run)": "'path'. It takes response",
    "rf.report(run, 'x.pdf')": "the name ends in '.pdf'",
    "rf.report(SYSTEM, 'x.html')": "expected a dataset",
    "rf.report(run, 'x.html', motion='x.AT2', certify=False)": "motion must be a GroundMotion",
    "rf.report(run, 'x.html', motion=RECORD, certify=False)": "not those of the run",
    "rf.report(run.drop_vars('status'), 'x.html')": "is no result of a run or of a study",
    "xr.Dataset().rockframe.plot()": "no function of rf.plot draws this dataset",
    "xr.Dataset().rockframe.player()": "rf.plot.player needs the result of one run",
    "xr.Dataset().rockframe.table()": "the dataset holds no scalars",
    "xr.Dataset().rockframe.system": "'system_json'",
    "rf.plot.response('out.nc')": "xr.open_dataset('out.nc')",
    "rf.plot.response(RECORD)": "rf.plot.motion and rf.plot.spectra draw it",
    "rf.plot.response(SYSTEM)": "rf.plot.scene draws it",
    "rf.plot.response(FRAGILITY)": "rf.plot.fragility draws it",
    "rf.plot.response(run, window=(0, 1))": "window needs a time with a unit, got 0",
    "rf.plot.response(run, rotation='m')": "rotation needs an angle",
    "rf.plot.response(run, units={'rotation': 'deg'})": "known are length",
    "rf.plot.response(run, color='red')": "'color'. It takes runs",
    "rf.plot.response(run, ax='x')": "ax must be 4 Axes",
    "rf.plot.response(run.drop_vars('contact_state'))": "lacks 'contact_state'",
    "rf.plot.response(run.assign(rotation=run.rotation.astype(str)))": "holds no numbers",
    "rf.plot.fragility(run)": "rf.plot.response draws it",
    "rf.plot.energies(run)": "outputs=('energy',)",
    "rf.plot.state(run, 1.0)": "time needs a time with a unit, got 1.0",
    "rf.plot.state(run, magnify=-1)": "magnify must be greater than zero",
    "rf.plot.moment_rotation(SYSTEM, largest=-1)": "largest must be greater than zero",
    "rf.plot.suite(SUITE, target=3)": "target needs a TargetSpectrum, got 3",
    "rf.plot.scene(BLOCK)": "rf.plot.scene needs a System",
    "rf.plot.sweep(xr.Dataset())": "rf.plot.sweep needs the result of a sweep",
    "rf.plot.velocity_pulse(run)": "rf.plot.velocity_pulse needs a VelocityPulse",
    "rf.plot.player(run, title=3)": "title must be a text, got 3",
    # codes, exports, tests, proofs, user-defined parts
    "rf.codes.circolare_2019(GROUND, TARGET)": "system needs a System",
    "rf.codes.circolare_2019(SYSTEM, 0.3)": "expected a GroundMotion or several",
    "rf.codes.circolare_2019(SYSTEM, TARGET)": "a damping ratio of 0.08, got 0.05",
    "rf.codes.circolare_2019(SYSTEM, TARGET, free_vibration=20)": "free_vibration needs a time",
    "rf.codes.asce_7_22(BLOCK)": "'spectral_acceleration'. It takes block",
    "rf.codes.asce_7_22(BLOCK, spectral_acceleration='1 g_0')": "spectral_acceleration needs",
    "rf.codes.asce_7_22(BLOCK, {'a': 3}, spectral_acceleration=1)": "'a' needs a GroundMotion",
    "rf.export.to_pelicun(FRAGILITY)": "'component'. It takes fragility",
    "rf.export.to_pelicun(FRAGILITY, 3)": "component must be a text, got 3",
    "rf.export.to_pelicun(FRAGILITY, 'x', offset=1.5)": "offset must be a whole number",
    "rf.export.to_pelicun(FRAGILITY, 'x', directional='no')": "directional must be True or False",
    "rf.export.to_openquake(FRAGILITY, 'x.xml')": "fragilities must be a mapping",
    "rf.export.to_openquake({'a': FRAGILITY}, 'x.xml', category=3)": "category must be a text",
    "rf.export.to_opensees(SYSTEM, RECORD, 'x.py', springs=0)": "springs must be a whole number",
    "rf.export.to_opensees(BLOCK, RECORD, 'x.py')": "needs a System",
    "decay(peaks=[0.1, 0.05])": "peaks needs rotations with a unit",
    "decay(parameters=3)": "parameters must be a list of names, got 3",
    "decay(confidence=95)": "confidence must be above 0 and below 1",
    "rf.fit_free_decay(SYSTEM)": "give measured (a history) or peaks, got neither",
    "rf.prove(SYSTEM)": "there is no motion",
    "rf.prove(SYSTEM, PULSE, parts=0)": "parts must be a whole number",
    "rf.prove_critical_scale(SYSTEM, PULSE, width=0)": "width must be from",
    "rf.register(rf.Block)": "expected a class derived from OwnBase",
    "rf.register(len, columns=3)": "columns must be a list of Variables, got 3",
    "rf.register(lambda state: 0, name='top', unit='banana', long_name='x')": "'banana'",
    "rf.extension.Parameter('m', doc='x')": "measure must be a rockframe.units.Measure, got 'm'",
    "rf.extension.Ratio(doc=3)": "doc must be a text, got 3",
    "rf.extension.Choice('a', doc='x')": "default must be one of the words of a StrEnum, got 'a'",
    "rf.extension.link_law(3)": "a law is a NamedTuple, got 3",
    "rf.extension.point_law(3)": "a law is a NamedTuple, got 3",
}

LINES = {
    "runn scene.toml": "'run'",
    "run": "scene.toml",
    "run scene.toml --moton record.AT2": "'--motion'",
    "run scene.toml --accuracy fsat": "'fast'",
    "run scene.toml --accuracy 5": "--accuracy: rtol must lie from",
    "run scene.toml --free-vibration 20": "free_vibration needs a time in a unit",
    "run scene.toml --scale two": "expected a number such as 1.5, got 'two'",
    "run scene.toml --motion none.AT2": "none.AT2: found no such file",
    "run scene.toml --motion record.AT2 --component NS": "'NS'",
    "run scene.toml --component NS": "--component NS: this says how a record is read",
    "run scene.toml --unit g": "--unit g: this says how a record is read",
    "run scene.toml -o out.csv": "out.csv: the name ends in '.csv'",
    "run scene.toml -o none/out.nc": "there is no folder 'none'",
    "run scene.toml extra.toml": "extra.toml",
    "run out.nc": "out.nc: this is no text",
    "run study.toml": "'axes' belongs to a study, which 'rockframe study' runs",
    "describe scene.tml": "scene.tml: there is no such file",
    "motion record.AT2 --picture x.jpg": "x.jpg: the name ends in '.jpg'",
    "motion scene.toml": "scene.toml",
    "plot out.nc -o x.png --formt svg": "'--format'",
    "plot out.nc -o x.png --format svg": "--format svg: this option is for the standard output",
    "plot cut.nc -o x.png": "cut.nc: this is no netCDF file",
    "animate out.nc -o x.html --format gif": "--format gif: this option is for the standard output",
    "animate out.nc -o x.html --window 0 1": "window needs a time",
    "study scene.toml": "a study needs [axes]",
    "certify scene.toml --nudge 2": "nudge must be above 0",
    "report out.nc -o x.pdf": "x.pdf: the name ends in '.pdf'",
    "report runs.nc --case scal=1": "'scale'",
    "report out.nc --units forc=kN": "'force'",
    "critical scene.toml --larges 3": "'--largest'",
    "critical scene.toml --intensity PGAA": "'PGA'",
    "fragility scene.toml record.AT2 --scales 1:2": "--scales: expected numbers without a unit",
    "fragility scene.toml record.AT2 --limits uplfit": "'uplift'",
    "fragility scene.toml record.AT2 --limits 'peak_slp=5 cm'": "'peak_slip'",
    "fragility scene.toml --unit g": "--unit g: this says how a record is read",
    "fragility runs.nc --time-step '0.1 s'": "runs.nc: this is a result",
    "ida scene.toml record.AT2 --scales 1": "scale needs 2 to 100000 different numbers",
    "map scene.toml --amplitude 1:10:1 --frequency '1 Hz'": "--amplitude: expected numbers",
    "convert record.AT2 -o record.AT2": "record.AT2: this file is an input",
    "convert record.AT2 -o x.dat": "x.dat: the ending gives no format",
    "serve --port x": "'x'",
    "completion fishes": "'fish'",
    "template blok": "'block'",
}

SCENE = TEMPLATES["block"].split("[run]", maxsplit=1)[0] + '[run]\naccuracy = "fast"\n'
STUDY = 'scene = "scene.toml"\nmotions = ["record.AT2"]\n'
FILES = {
    # faults of files of scenes and studies, with the line and the message
    SCENE.replace("[block]", "[blok]"): (4, "unknown key 'blok'; was 'block'"),
    SCENE.replace("width", "widht"): (5, "unknown key 'widht'; was 'width'"),
    SCENE.replace('"0.8 m"', "0.8"): (5, "[block]: width needs a length with a unit"),
    SCENE.replace('"0.8 m"', "0.8 m"): (5, "this is no TOML"),
    SCENE.replace("sine_pulse", "sine_puls"): (10, "was 'sine_pulse'"),
    SCENE.replace("amplitude", "amplitde"): (11, "was 'amplitude'"),
    f'{SCENE}acuracy = "fast"\n': (16, "was 'accuracy'"),
    f"{SCENE}free_vibration = 20\n": (16, "simulate: free_vibration needs a time"),
    f'{SCENE}outputs = ["energi"]\n': (16, "was 'energy'"),
    f'{SCENE}initial = {{ rotaton = "0.1 rad" }}\n': (16, "was 'rotation'"),
    f'{SCENE}[system]\nrestraint = "center"\n': (17, "was 'centre'"),
    f"{SCENE}[system]\ngravity = 9.81\n": (17, "gravity needs an acceleration with a unit"),
    f"{SCENE}[pads]\nfrequency_ratio = 40\n": (16, "give damping_ratio or damping"),
    f'{SCENE}[[restrainers]]\nname = "a"\n': (16, "was 'restrainer'"),
    f'{SCENE}[project]\nobjekt = "x"\n': (17, "was 'object'"),
    f"{STUDY}[axes]\nwidht = [1]\n": (4, "was 'width'"),
    f"{STUDY}[axes]\nwidth = [1]\n": (4, "width needs a length with a unit"),
    f"{STUDY}[axis]\nscale = [1]\n": (3, "was 'axes'"),
    f'{STUDY}[axes]\nscale = [1]\n[sweep]\nacuracy = "fast"\n': (6, "was 'accuracy'"),
    f'{STUDY}cases = "none.csv"\n': (3, "none.csv"),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Make a folder with a scene, a study, a record, results, and invalid files."""
    place = tmp_path_factory.mktemp("misuses")
    (place / "scene.toml").write_text(SCENE)
    (place / "study.toml").write_text(f"{STUDY}[axes]\nscale = [1.0]\n")
    RECORD.to_at2(place / "record.AT2")
    (place / "nums.txt").write_text("\n".join(["0.1"] * 50))
    (place / "noise").write_bytes(bytes(range(256)) * 20)
    (place / "empty.AT2").touch()
    (place / "kept").mkdir()
    run = SYSTEM.simulate(PULSE, accuracy="fast")
    run.to_netcdf(place / "out.nc")
    (place / "cut.nc").write_bytes((place / "out.nc").read_bytes()[:3000])
    runs = sweep(SUITE, scale=[0.5, 1.0], store=place / "store")
    runs.to_netcdf(place / "runs.nc")
    shutil.copytree(place / "store", place / "cut")
    study = place / "cut" / "study.json"
    study.write_bytes(study.read_bytes()[:200])
    return place, {"run": run, "runs": runs}


@pytest.fixture
def inside(folder, monkeypatch):
    """Change to that folder."""
    monkeypatch.chdir(folder[0])
    return folder[1]


def exception_of(row, namespace):
    """Evaluate a row and return the exception."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            result = eval(row, {**LIBRARIES, **globals(), **namespace})  # noqa: S307
        except Exception as problem:
            return problem
    return AssertionError(f"was taken: {result!r:.60}")


def fault_of(row, words, problem):
    """Return what is wrong with an exception, or an empty text."""
    message = str(problem)
    if not isinstance(problem, RockframeError):
        return f"{row}: {type(problem).__name__}: {message}"
    return None if words in message else f"{row}: says {message}"


@pytest.mark.parametrize("rows", [NAMES, VALUES], ids=["names", "values"])
def test_each_misuse_is_refused_by_its_name(rows, inside):
    files = sorted(Path().rglob("*"))
    faults = [fault_of(row, words, exception_of(row, inside)) for row, words in rows.items()]
    assert not [one for one in faults if one]
    assert sorted(Path().rglob("*")) == files, "refused calls wrote files"


def test_misspelt_names_get_a_suggestion(inside):
    silent = [row for row in NAMES if "meant?" not in str(exception_of(row, inside))]
    assert not silent


def run_command(words, capsys):
    """Run a command; return its exit code and all its output."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        code = main(words)
    return code, "".join(capsys.readouterr())


def test_mistyped_command_lines_are_refused(inside, capsys):
    files = sorted(Path().rglob("*"))
    faults = []
    for line, words in LINES.items():
        code, output = run_command(shlex.split(line), capsys)
        if code != 2 or "Traceback" in output or words not in output:
            faults.append(f"{line}: {code} {output}")
    assert not faults
    assert sorted(Path().rglob("*")) == files


def test_invalid_files_are_refused_with_file_name(inside, capsys, tmp_path, monkeypatch):
    for name in ("scene.toml", "record.AT2"):
        shutil.copy(name, tmp_path)
    monkeypatch.chdir(tmp_path)
    faults = []
    for text, (line, words) in FILES.items():
        Path("wrong.toml").write_text(text)
        command = "study" if text.startswith(STUDY) else "describe"
        code, output = run_command([command, "wrong.toml"], capsys)
        if code != 2 or f"wrong.toml, line {line}: " not in output or words not in output:
            faults.append(f"{text.splitlines()[-3:]}: {code} {output}")
    assert not faults


def test_misuse_tables_have_hundreds_of_rows():
    assert len(NAMES) + len(VALUES) + len(LINES) + len(FILES) > 350


def callables():
    """Return all public functions, classes and their methods, with their names."""
    modules = [value for value in (getattr(rf, name) for name in rf.__all__)
               if isinstance(value, ModuleType) and value is not rf.extension]  # fmt: skip
    for module in (rf, *modules):
        for name in dir(module):
            value = getattr(module, name)
            if isclass(value) and not issubclass(value, BaseException):
                yield name, value
                for method in dir(value):
                    plain = getattr_static(value, method)
                    kinds = (FunctionType, classmethod, staticmethod)
                    if not method.startswith("_") and isinstance(plain, kinds):
                        yield f"{name}.{method}", getattr(value, method)
            elif callable(value) and not isclass(value):
                yield name, value


OF_PYTHON = ("MotionSuite.get", "MotionSuite.items", "MotionSuite.keys", "MotionSuite.values",
             "Panels")  # fmt: skip
TAKING_ANYTHING = ("System", "GroundMotion")


def test_wrong_arguments_raise_rockframe_errors():
    silent = []
    for name, one in callables():
        if name in OF_PYTHON:
            continue
        parameters = signature(one).parameters.values()
        tried = [] if any(each.kind is each.VAR_KEYWORD for each in parameters) else [
            ([], {"nothing_of_the_kind": 1})
        ]  # fmt: skip
        tried += [] if name in TAKING_ANYTHING else [([None] * 60, {})]
        for arguments, named in tried:
            try:
                one(*arguments, **named)
            except ArgumentError:
                continue
            except Exception as problem:
                silent.append(f"{name}: {problem!r}")
            else:
                silent.append(f"{name} took it")
    assert not silent


def test_missing_attributes_behave_as_in_python():
    assert not hasattr(BLOCK, "__array__")
    assert not hasattr(rf.plot, "respones")
    assert getattr(SYSTEM, "simulat", None) is None
    with pytest.raises(AccessError) as caught:
        rf.Block._none  # noqa: B018
    assert "meant?" not in str(caught.value)


def test_failing_property_reports_its_cause():
    class Leaning(rf.extension.Component):
        """A part whose property reads a missing attribute."""

        @property
        def angle(self):
            return self.given.slope

    with pytest.raises(AttributeError, match="'slope'"):
        Leaning().angle  # noqa: B018


def test_system_survives_json_round_trip():
    assert rf.System.from_dict(json.loads(json.dumps(SYSTEM.to_dict()))) == SYSTEM
