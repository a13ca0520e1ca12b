#!/usr/bin/env python3
"""Processor time of stills by two builds: still_ratio.py OLD NEW FOLDER [RUNS] [OPTION ..]

Renders every .glb and .gltf file below FOLDER at 512 x 512 with both commands by turns, RUNS (3) times each, and prints for each
model the medians of user and system time in ms and their ratio OLD / NEW, then the median of these ratios. OPTIONs go to
`facet render`. The light is facet's own; a model that one of the two refuses is named and left out.
"""
import os
import pathlib
import statistics
import sys
import tempfile


def measure(command):
    """Processor time in ms; None: it failed."""
    silence = [(os.POSIX_SPAWN_OPEN, number, os.devnull, os.O_WRONLY, 0) for number in (1, 2)]
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=silence)
    _, status, usage = os.wait4(pid, 0)
    return None if status else 1e3 * (usage.ru_utime + usage.ru_stime)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    builds, folder, runs = sys.argv[1:3], pathlib.Path(sys.argv[3]), int((sys.argv[4:5] or ["3"])[0])
    models = sorted(path for path in folder.rglob("*") if path.suffix in (".glb", ".gltf"))
    ratios = []
    with tempfile.TemporaryDirectory() as work:
        for model in models:
            commands = [[build, "render", str(model), "-q", "-s", "512x512", "-o", f"{work}/still.png", *sys.argv[5:]]
                        for build in builds]
            times = [[measure(command) for command in commands] for _ in range(runs)]
            if any(None in pair for pair in times):
                print(f"{model.name:40} is refused")
                continue
            old, new = (statistics.median(column) for column in zip(*times))
            ratios.append(old / new)
            print(f"{model.name:40} {old:7.1f} {new:7.1f}  {old / new:5.2f}", flush=True)
    if ratios:
        print(f"{len(ratios)} models, median {statistics.median(ratios):.3f}, {min(ratios):.2f} to {max(ratios):.2f}")


if __name__ == "__main__":
    main()
