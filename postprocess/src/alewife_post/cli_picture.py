"""Command `picture` of `alewife-post`, and the options it has in common with `film`."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from alewife_post import cli_look, cli_series
from alewife_post.read import Run, open_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def add_picture(parser: argparse.ArgumentParser) -> None:
    """Options of `picture`."""
    from alewife_post import figure

    add_run(parser, are_several=True)
    add_look(parser, figure.QUANTITIES)
    cli_look.add_colours(parser, has_contours=True)
    cli_look.add_letters(parser)
    parser.add_argument(
        "--time", type=float, nargs="+", metavar="T",
        help="time of the frame; the last one if absent; several: a panel each, on one scale",
    )  # fmt: skip
    parser.add_argument(
        "--scene", action="store_true",
        help="in space: fluid on a plane, bodies with pressure, sides, streamlines, names",
    )  # fmt: skip
    parser.add_argument(
        "--on", action="append", default=[], metavar="NAME",
        help="of --surface: bodies or sides instead of all bodies; may be given again",
    )  # fmt: skip
    parser.add_argument("--frame", metavar="BODY", help="subtract the velocity of this body")
    parser.add_argument(
        "--lines", choices=("streamlines", "arrows", "none"), help="streamlines if absent, of speed"
    )
    add_particles(parser)


def write_picture(options: argparse.Namespace) -> None:
    """One picture of a run, or panels of several runs or times."""
    cli_look.check_ending(options.out)
    runs = [open_run(path) for path in options.run]
    for run in runs:
        for time in options.time or ():
            run.check_time(time)
    cli_series.save(cli_look.finish(_picture(runs, options), options), options.out)


def _picture(runs: list[Run], options: argparse.Namespace) -> Figure:
    run, view = runs[0], options.view and tuple(options.view)
    times = options.time or [None]
    if any("soft" in one.case for one in runs):
        return _soft(runs, times, options)
    if not any(one.is_spatial for one in runs):
        refuse_in_the_plane(options)
        return _in_the_plane(runs, times, options)
    if len(runs) * len(times) > 1:
        raise ValueError(
            "panels are of runs in the plane or about an axis: in space draw pictures one by one, "
            "with the same --limits"
        )
    time, quantity = times[0], options.quantity
    if options.on and not options.surface:
        raise ValueError("--on is for --surface")
    if options.particles and (options.scene or options.surface or options.slice):
        raise ValueError("--particles in space are drawn without --scene, --surface and --slice")
    if options.contours and (options.scene or options.surface or options.iso or options.particles):
        raise ValueError("--contours are drawn on slices and in the plane")
    if options.iso or options.particles or (options.follow and not options.slice):
        return _still(run, options)
    if options.scene:
        return _scene(run, options)
    from alewife_post import scene, slices, space

    look = cli_look.scale(options)
    if options.surface:
        camera = tuple(options.camera or scene.CAMERA)
        return space.surface_picture(
            run, quantity or "pressure", time=time, camera=camera, on=options.on, scale=look
        )
    return slices.slice_picture(
        run, quantity or "speed", time=time, plane=options.slice, view=view, frame=options.frame,
        lines=options.lines or "streamlines", painter=options.painter, scale=look,
    )  # fmt: skip


def _soft(runs: list[Run], times: list[float | None], options: argparse.Namespace) -> Figure:
    from alewife_post import soft

    if len(runs) * len(times) > 1:
        raise ValueError("soft cases have no panels: draw one by one, with the same --limits")
    of_flows = ("slice", "surface", "iso", "scene", "follow", "frame", "lines", "on", "particles")
    given = [f"--{name}" for name in (*of_flows, "contours") if getattr(options, name)]
    if given:
        raise ValueError(f"{', '.join(given)}: of runs with a flow; this is one of a soft case")
    if options.view and runs[0].is_spatial:
        raise ValueError("--view is for runs in the plane: in space --camera says where from")
    if options.camera and not runs[0].is_spatial:
        raise ValueError("--camera is for runs in space")
    return soft.picture(
        runs[0], options.quantity or "displacement", time=times[0],
        view=options.view and tuple(options.view),
        look_from=options.camera and tuple(options.camera),
        mirror=not options.half, scale=cli_look.scale(options),
    )  # fmt: skip


def _in_the_plane(
    runs: list[Run], times: list[float | None], options: argparse.Namespace
) -> Figure:
    from alewife_post import figure

    wanted = [
        (run, figure.Shown(
            time, options.view and tuple(options.view), options.frame, options.follow,
            options.lines, not options.half, options.painter, options.particles,
        ))
        for run in runs
        for time in times
    ]  # fmt: skip
    return figure.panels(wanted, options.quantity or "speed", cli_look.scale(options))


def _scene(run: Run, options: argparse.Namespace) -> Figure:
    from alewife_post import stills

    given = ("slice", "surface", "iso", "follow", "view", "frame", "lines", "half")
    beside = [f"--{name}" for name in given if getattr(options, name)]
    if beside:
        raise ValueError(f"--scene has a view of its own: leave out {', '.join(beside)}")
    return stills.scene_picture(
        run, quantity=options.quantity or "speed", time=options.time and options.time[0],
        look_from=options.camera and tuple(options.camera), scale=cli_look.scale(options),
    )  # fmt: skip


def _still(run: Run, options: argparse.Namespace) -> Figure:
    """A run in space as one frame of its film."""
    from alewife_post import film, stage, style, tracers

    field = run.frame(options.time and options.time[0])
    style.use()
    request = film.Request(
        quantity=_filmed(options),
        follow=options.follow,
        trails=False,
        surface=options.surface,
        iso=options.iso,
        camera=options.camera and tuple(options.camera),
        particles=options.particles,
        scale=cli_look.scale(options),
        is_still=True,
    )
    if options.particles and run.is_unsteady:
        tracers.read_paths(options.particles).check_time(field.time, options.particles)
    return stage.still(run, film.Moment(field.time, field.path), request)


def _filmed(options: argparse.Namespace) -> str:
    if options.iso:
        return "iso"
    if options.particles and not options.quantity:
        # A plane would hide those that are behind it, or in it
        return "bodies"
    return options.quantity or ("pressure" if options.surface else "speed")


# ---- In common -----------------------------------------------------------------------------------


def add_particles(parser: argparse.ArgumentParser) -> None:
    """Paths that are drawn as well."""
    parser.add_argument(
        "--particles",
        type=Path,
        metavar="DIR",
        help="draw what `alewife-post trace` wrote as well, or the tracers of a run",
    )


def add_run(parser: argparse.ArgumentParser, *, are_several: bool = False) -> None:
    """The run, and the file that is written."""
    if are_several:
        parser.add_argument(
            "run", type=Path, nargs="+", help="run directory; several: a panel each, on one scale"
        )
    else:
        parser.add_argument("run", type=Path, help="run directory")
    parser.add_argument("--out", type=Path, required=True, help="file; its ending says the format")


def add_look(parser: argparse.ArgumentParser, quantities: tuple[str, ...]) -> None:
    """What is seen, and where from."""
    known = ", ".join(quantities)
    parser.add_argument(
        "--quantity", metavar="NAME",
        help=f"{known}, or a scalar of the run; speed, on surfaces pressure, if absent; of a soft "
        "case displacement, if absent, strain, speed, volume-ratio, pressure or mesh",
    )  # fmt: skip
    parser.add_argument(
        "--view",
        type=float,
        nargs=4,
        metavar=("XMIN", "XMAX", "YMIN", "YMAX"),
        help="of a slice in its own coordinates, about who is followed relative to that",
    )
    parser.add_argument("--half", action="store_true", help="one side of the axis only")
    only_one = parser.add_mutually_exclusive_group()
    only_one.add_argument(
        "--slice",
        metavar="PLANE",
        help="plane of a run in space, such as z=0.5; through the bodies if absent",
    )
    only_one.add_argument(
        "--surface", action="store_true", help="in space the bodies, without any the sides"
    )
    only_one.add_argument(
        "--iso",
        metavar="QUANTITY",
        help="in space the surface of equal vorticity, or of a value: vorticity=2.5",
    )
    parser.add_argument(
        "--follow",
        metavar="NAME",
        help="body or swimmer the view goes with; of films `none` leaves the frame of the run",
    )
    parser.add_argument(
        "--camera",
        type=float,
        nargs=2,
        metavar=("AZIMUTH", "ELEVATION"),
        help="where bodies are looked at from, degrees about z and above the horizon",
    )
    parser.add_argument("--painter", choices=("auto", "vtk", "matplotlib"), default="auto")


def refuse_in_the_plane(options: argparse.Namespace) -> None:
    """ValueError where an option is for runs in space."""
    if options.surface or options.slice or options.iso or getattr(options, "scene", False):
        more = (
            "; in the plane --quantity wall-shear colours outlines, and alewife-post surface has "
            "curves along them"
        )
        raise ValueError(
            "--surface, --slice, --iso and --scene are for runs in space"
            + (more if options.surface else "")
        )
    if getattr(options, "on", []):
        raise ValueError(
            "--on is for runs in space: alewife-post surface --on has curves of a side"
        )
    if options.camera:
        raise ValueError("--camera is for runs in space")
