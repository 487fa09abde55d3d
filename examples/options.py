"""Command-line options that examples have in common."""

import argparse
import os

import common


def parser_of(name, description):
    return argparse.ArgumentParser(prog=f"examples/run {name}", description=description)


def whole_number_from_one(text):
    """An option's value, checked by argparse."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"is {value}, but must be at least 1")
    return value


def add_ranks(parser):
    parser.add_argument("--ranks", type=whole_number_from_one, default=os.cpu_count(), metavar="N",
                        help="MPI ranks (default: all cores, here %(default)s)")


def add_run(parser, name):
    """Options of an example that runs in one go."""
    add_ranks(parser)
    parser.add_argument("--out", default=str(common.ROOT / "out" / name), metavar="DIR",
                        help=f"directory for the results (default out/{name})")


def add_limits(parser):
    """Options for how much of the machine a run takes."""
    add_ranks(parser)
    parser.add_argument("--hours", type=float, default=2.0, metavar="H",
                        help="stop with a checkpoint after so many hours, exit code 75; the same "
                             "command goes on (default %(default)g)")


def add_pieces(parser, name):
    """Options of an example that runs in pieces."""
    add_limits(parser)
    parser.add_argument("--fresh", action="store_true",
                        help="begin anew even where a checkpoint or a result is there")
    parser.add_argument("--no-pictures", action="store_true", help="numbers only")
    parser.add_argument("--out", default=None, metavar="DIR",
                        help=f"directory for results and checkpoints (default out/{name})")


def add_number(parser, option, unit, text, default=None):
    """`default`: a number, or words for what a preset decides; None: `text` says it."""
    if isinstance(default, str):
        parser.add_argument(option, type=float, metavar=unit, help=f"{text} (default {default})")
    else:
        known = "" if default is None else " (default %(default)g)"
        parser.add_argument(option, type=float, metavar=unit, default=default, help=text + known)


def add_count(parser, default):
    """For grains of 2 mm that stand for themselves."""
    parser.add_argument("--grains", type=int, default=default, metavar="N",
                        help="number of grains of 2 mm (default %(default)s)")


def add_grains(parser, grain, spring):
    """`grain`, `spring`: text and default."""
    add_number(parser, "--grain", "L", "coarse-grain ratio l" + grain[0], grain[1])
    add_number(parser, "--spring", "K", "spring constant of the original particle, N/m" + spring[0],
               spring[1])


def add_start_up(parser, default):
    add_number(parser, "--start-up", "T", "time that the means leave out, s", default)


def add_closures(parser, friction, restitution):
    add_number(parser, "--friction", "MU", "coefficient of friction", friction)
    add_number(parser, "--restitution", "E", "coefficient of restitution, above 0.05 and at most 1",
               restitution)
    add_number(parser, "--kernel", "MM", "standard deviation of the kernel, mm (default: the larger "
               "of 0.8 cells and 1.2 grains)")
    parser.add_argument("--mapping", metavar="NAME", help="of grains to cells (default: the spline, "
                        "smoothed to the kernel; others are not smoothed unless --kernel is given)")
    parser.add_argument("--drag", default="gidaspow", metavar="NAME",
                        help="drag closure (default %(default)s)")


def fill_in(chosen, preset):
    """Gives options that were not stated their values of `preset`."""
    for name, value in preset.items():
        if getattr(chosen, name) is None:
            setattr(chosen, name, value)


def require(parser, chosen, lowest):
    """Ends with an error unless each option is at least, or (0) above, its lowest value."""
    for name, bound in lowest.items():
        value = getattr(chosen, name)
        if not (value >= bound if bound else value > 0):
            parser.error(f"--{name.replace('_', '-')} is {value:g}, but must be "
                         + (f"at least {bound:g}" if bound else "positive"))


def require_restitution(parser, chosen):
    if not 0.05 < chosen.restitution <= 1:
        parser.error(f"--restitution is {chosen.restitution:g}, but must lie in (0.05, 1]")


def require_start_up(parser, chosen):
    if not 0 <= chosen.start_up < chosen.time:
        parser.error(f"--start-up is {chosen.start_up:g}, but must lie in [0, {chosen.time:g}), "
                     "the simulated time")
