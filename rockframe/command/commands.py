"""The commands and their arguments; no library is imported, so that help is immediate."""

from typing import Final

from rockframe.command.arguments import (
    ANALYSIS_ARGUMENTS,
    DURATION_OPTIONS,
    INTENSITY_OPTIONS,
    MOTION_FILES,
    OUTPUT_OPTION,
    OVERWRITE_OPTION,
    PICTURE_HELP,
    PICTURE_OPTION,
    READING_OPTIONS,
    RESULT_FILE,
    RUN_OPTIONS,
    SCENE_FILE,
    STORE_OPTION,
    SWEEP_ACCURACY_OPTION,
    UNITS_OPTION,
    Command,
    argument,
    file_argument,
    integer_option,
    number_option,
)

COMMANDS: Final = (
    Command(
        "template",
        "runs",
        "write a scene or a study to begin with",
        "Write a file to begin with. Change its numbers, which have their units, and run it.",
        """\
  rockframe template > scene.toml            a block on rigid ground
  rockframe template stack > scene.toml      a frame on pads, cap and soil
  rockframe template statue > scene.toml     a statue on a plinth, with an outline
  rockframe template study > study.toml      many runs of one scene
  rockframe template all                     every table and key, with its meaning""",
        (
            argument(
                "kind",
                nargs="?",
                default="block",
                choices=("block", "pads", "soil", "stack", "statue", "study", "all"),
                help="kind of the file (default: block)",
            ),
        ),
    ),
    Command(
        "describe",
        "runs",
        "describe the model of a scene, with its numbers",
        "Check the file of a scene, and describe its model: the equations, the frequencies and "
        "what the model neglects. Nothing is simulated.",
        "  rockframe describe scene.toml",
        (SCENE_FILE,),
    ),
    Command(
        "motion",
        "motions",
        "list what files of ground motions contain",
        "List the components of files, archives and folders as agencies publish them, with "
        "their intensity measures.",
        """\
  rockframe motion record.AT2
  rockframe motion record.AT2 --picture record.png
  rockframe motion PEERNGARecords.zip --csv measures.csv""",
        (
            MOTION_FILES,
            *READING_OPTIONS,
            file_argument(
                "--picture",
                metavar="x.png",
                help=f"write {PICTURE_HELP}; of several motions one each, numbered",
            ),
            file_argument(
                "--csv", metavar="x.csv", help="write the table of measures, for a spreadsheet"
            ),
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "convert",
        "motions",
        "write records in formats of other programs",
        "Read records of any format that rockframe knows, and write them as AT2 (of PEER), as CSV "
        "or as netCDF, which keeps all that is known of them. The components that 'motion' lists "
        "are those that are written.",
        """\
  rockframe convert CHI012.V2 --component N12W -o record.AT2
  rockframe convert record.AT2 -o record.csv
  rockframe convert PEERNGARecords.zip --to at2 -o records     a file for each, in a folder
  rockframe convert PEERNGARecords.zip -o suite.nc             all of them in one file
  rockframe convert - --to csv -o - < record.AT2""",
        (
            MOTION_FILES,
            file_argument(
                "-o",
                "--output",
                required=True,
                metavar="x.AT2",
                help="the file, ending in .AT2, .csv or .nc; with --to, a folder or -",
            ),
            argument(
                "--to",
                choices=("at2", "csv", "nc"),
                help="the format, where the ending of the file does not give it",
            ),
            *READING_OPTIONS,
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "run",
        "runs",
        "simulate a scene under a motion",
        "Simulate a scene, print the verdict, and write all results to a netCDF file, which "
        "'plot', 'report', xarray, MATLAB and many others read.",
        """\
  rockframe run scene.toml                                 the motion is in the scene
  rockframe run scene.toml --motion record.AT2 -o out.nc
  rockframe run scene.toml --motion record.AT2 --scale 1.5 --accuracy fast""",
        (SCENE_FILE, *RUN_OPTIONS, OUTPUT_OPTION, OVERWRITE_OPTION),
    ),
    Command(
        "certify",
        "runs",
        "check how certain the verdict of a run is",
        "Simulate a scene, and then repeat it about a hundred times: with finer accuracy, with "
        "parameters changed a little, and under the scaled motion. Report whether the verdict "
        "remains the same.",
        """\
  rockframe certify scene.toml --motion record.AT2
  rockframe certify scene.toml --motion record.AT2 --nudge 0.01 -o out.nc
  rockframe certify scene.toml --motion record.AT2 --proved""",
        (
            SCENE_FILE,
            *RUN_OPTIONS,
            number_option(
                "--nudge", "SHARE", "largest relative change of each parameter (default: 0.001)"
            ),
            number_option(
                "--reach", "SHARE", "largest relative change of the scale (default: 0.5)"
            ),
            argument(
                "--proved",
                action="store_true",
                help="prove the verdict of a block on rigid ground or pads (needs python-flint)",
            ),
            integer_option("--runs", "largest number of further runs (default: 200)"),
            OUTPUT_OPTION,
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "critical",
        "analyses",
        "find the least scale of a motion that overturns",
        "Scale the motion of a scene, and find the least scale at which the body overturns, its "
        "peak ground acceleration, and all ranges of larger scales at which it stands again.",
        """\
  rockframe critical scene.toml
  rockframe critical scene.toml --motion record.AT2 --picture critical.png
  rockframe critical scene.toml --motion record.AT2 --intensity SA --period '0.5 s' --json""",
        (
            SCENE_FILE,
            *RUN_OPTIONS,
            number_option("--largest", "FACTOR", "largest scale that is tried (default: 4)"),
            integer_option(
                "--runs",
                "largest number of runs of the scan; more of them find narrower ranges that "
                "overturn (default: 400)",
            ),
            *INTENSITY_OPTIONS,
            OUTPUT_OPTION,
            PICTURE_OPTION,
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "study",
        "analyses",
        "run a scene with many values of its parameters",
        "Run a scene at all combinations of values, or at all rows of a table, under one motion "
        "or many. With a store, a folder, finished cases are kept: the same command continues "
        "where it was interrupted.",
        """\
  rockframe study study.toml
  rockframe study study.toml --store kept -o runs.nc
  rockframe study study.toml --csv runs.csv""",
        (
            file_argument(
                "study", metavar="study.toml", help="the study; 'template study' writes one; or -"
            ),
            STORE_OPTION,
            OUTPUT_OPTION,
            file_argument(
                "--csv", metavar="x.csv", help="write a table with one row for each case"
            ),
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "fragility",
        "analyses",
        "fit the probability of overturning by intensity",
        "Run a scene under many records at many scales, and fit lognormal fragilities: median and "
        "dispersion of the intensity at which it overturns. Or fit them to a finished study, given "
        "as out.nc or as its store.",
        """\
  rockframe fragility scene.toml PEERNGARecords.zip --picture fragility.png
  rockframe fragility scene.toml records --intensity SA --period '0.5 s' --scales 0.5:4:0.5
  rockframe fragility study.toml --store kept -o fragility.nc
  rockframe fragility runs.nc records --limits uplift,0.5 --json""",
        (*ANALYSIS_ARGUMENTS, OVERWRITE_OPTION),
    ),
    Command(
        "ida",
        "analyses",
        "scale many records until a scene overturns",
        "Incremental dynamic analysis: run a scene under records at increasing scales, and refine "
        "each scale at which it begins, or ceases, to overturn. Lists the capacity under each "
        "record.",
        """\
  rockframe ida scene.toml PEERNGARecords.zip --picture ida.png
  rockframe ida scene.toml records --scales 0.1:6:0.1 --csv capacities.csv -o ida.nc""",
        (
            *ANALYSIS_ARGUMENTS,
            file_argument(
                "--csv", metavar="x.csv", help="write the capacities, one row for each record"
            ),
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "map",
        "analyses",
        "find the pulses that overturn a scene",
        "Run a scene under pulses of the given amplitudes and frequencies, and find the boundaries "
        "of overturning: without an impact, after one impact, and the safe range between them.",
        """\
  rockframe map scene.toml --amplitude '1:10:1 m/s^2' --frequency '0.5:4:0.25 Hz' -o map.nc
  rockframe map scene.toml --amplitude '0.1,0.2,0.4 g' --frequency '1,2 Hz' --picture map.png
  rockframe map scene.toml --pulse cosine_pulse --amplitude '1:9:2 m/s^2' --frequency '1,2 Hz'""",
        (
            SCENE_FILE,
            argument(
                "--amplitude",
                required=True,
                metavar="VALUES",
                help="values with their unit: '1:10:0.5 m/s^2', from:to:step, or '1,2,4 m/s^2'",
            ),
            argument(
                "--frequency", required=True, metavar="VALUES", help="likewise '0.5:4:0.25 Hz'"
            ),
            argument(
                "--pulse",
                metavar="NAME",
                help="sine_pulse or cosine_pulse (default: that of the scene, else sine_pulse)",
            ),
            SWEEP_ACCURACY_OPTION,
            *DURATION_OPTIONS,
            STORE_OPTION,
            OUTPUT_OPTION,
            PICTURE_OPTION,
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "plot",
        "figures",
        "draw a result",
        "Draw the result in a file: a run over time, or the figure of a study or an analysis.",
        """\
  rockframe plot out.nc -o out.png --units angle=deg length=mm acceleration=g
  rockframe plot out.nc -o forces.png --panels base_shear left_reaction --units force=kN
  rockframe plot map.nc -o map.pdf --title 'A pulse on blocks of marble'""",
        (
            RESULT_FILE,
            file_argument(
                "-o", "--output", required=True, metavar="x.png", help=f"write {PICTURE_HELP}"
            ),
            argument(
                "--format",
                choices=("png", "svg", "pdf"),
                help="format of a picture that goes to the standard output (default: png)",
            ),
            OVERWRITE_OPTION,
            argument("--title", help="title of the figure, instead of the verdict"),
            UNITS_OPTION,
            argument(
                "--panels",
                nargs="+",
                metavar="NAME",
                help="panels of a run: ground, rotation, vertical, contact, and any of its "
                "histories",
            ),
        ),
    ),
    Command(
        "animate",
        "figures",
        "animate a run",
        "Write an animation of a run: a page with a slider (.html, fast, some tens of kB), or a "
        "film (.gif, .mp4, drawn picture by picture). Name a result, or a scene to be run.",
        """\
  rockframe animate out.nc -o run.html
  rockframe animate scene.toml --motion record.AT2 -o run.html
  rockframe animate out.nc -o run.gif --window '2 s' '8 s' --speed 0.5""",
        (
            file_argument("dataset", metavar="out.nc", help="a result of 'run', or a scene; or -"),
            file_argument(
                "-o",
                "--output",
                required=True,
                metavar="x.html",
                help="the file, ending in .html, .gif or .mp4 (which needs ffmpeg)",
            ),
            argument(
                "--format",
                choices=("html", "gif", "mp4"),
                help="format of what goes to the standard output (default: html)",
            ),
            argument(
                "--window", nargs=2, metavar=("START", "END"), help="times of the run to show"
            ),
            number_option("--speed", "FACTOR", "time in the run over time in the film"),
            number_option("--magnify", "FACTOR", "multiply displacements in the drawing by this"),
            argument("--title", help="title of the animation, instead of the verdict"),
            *RUN_OPTIONS,
            OVERWRITE_OPTION,
        ),
    ),
    Command(
        "report",
        "report",
        "write a page on a run or a study, to keep or to print",
        "Write one HTML file that needs no other: the scene, the motion and its measures, the "
        "verdict and its certificate, figures, limits of validity, and provenance. A run without "
        "certificate is certified first, if the file holds its motion. Of a study the page has all "
        "cases in a table, the worst one in full or the one that --case names, and the spectra of "
        "its records with a target spectrum. Checks by codes follow the verdict.",
        """\
  rockframe report out.nc
  rockframe report out.nc -o tower.html --title 'Clock tower, record 12'
  rockframe report runs.nc --units force=kN angle=deg
  rockframe report runs.nc --case scale=2 'width=0.7 m' -o case.html
  rockframe report runs.nc --motions records --target eurocode_8 'ground_acceleration=0.2 g_0'
  rockframe report out.nc --check circolare_2019 confidence_factor=1.35""",
        (
            RESULT_FILE,
            file_argument(
                "-o", "--output", metavar="x.html", help="the file (default: out.html for out.nc)"
            ),
            OVERWRITE_OPTION,
            argument(
                "--case",
                nargs="+",
                action="extend",
                metavar="NAME=VALUE",
                help="the case of a study, by its value along every axis of several values",
            ),
            argument("--title", help="title of the page"),
            UNITS_OPTION,
            file_argument(
                "--motion",
                metavar="RECORD",
                help="the record of the run, for its certificate, if the result does not hold it",
            ),
            file_argument(
                "--motions",
                nargs="+",
                metavar="FILE",
                help="the records of a study, for their spectra and its worst case, if the result "
                "does not hold them; archives and folders too",
            ),
            argument(
                "--target",
                nargs="+",
                metavar=("SPECTRUM", "NAME=VALUE"),
                help="target spectrum for those of the motions: eurocode_8 "
                "'ground_acceleration=0.2 g_0' ground_type=B; asce_7 with its arguments; or a "
                "table x.csv with the columns period [s], acceleration [g_0], and "
                "damping_ratio=0.08",
            ),
            argument(
                "--check",
                nargs="+",
                action="append",
                metavar=("CODE", "NAME=VALUE"),
                help="add a check by a code, for the motions of the result: circolare_2019 "
                "confidence_factor=1.35, or asce_7_22 spectral_acceleration=1.2",
            ),
            argument(
                "--no-certificate",
                action="store_true",
                help="do not certify a run that has no certificate",
            ),
        ),
    ),
    Command(
        "serve",
        "serve",
        "try a scene on a page with sliders",
        "Serve a page to browsers on this machine: sliders for the body, its base and the "
        "motion, the verdict, an animation of the run, and the scene as a file to download. Ctrl-C "
        "ends it.",
        """\
  rockframe serve
  rockframe serve record.AT2 --browse
  rockframe serve --port 8123""",
        (
            file_argument(
                "record", nargs="?", metavar="FILE", help="a record to offer on the page"
            ),
            *READING_OPTIONS,
            integer_option(
                "--port", "port of this machine; 0 for a free one (default: 8000)", 8000
            ),
            argument("--browse", action="store_true", help="open the page in the browser"),
        ),
    ),
    Command(
        "completion",
        "completion",
        "write a script that completes commands in a shell",
        "Write a script with which a shell completes commands, options and names of files.",
        """\
  bash   source <(rockframe completion bash)         in ~/.bashrc
  zsh    source <(rockframe completion zsh)          in ~/.zshrc
  fish   rockframe completion fish | source          in ~/.config/fish/config.fish""",
        (argument("shell", choices=("bash", "zsh", "fish"), help="the shell"),),
    ),
)
