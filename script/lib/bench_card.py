"""Table of a graphics card's times beside their goals, from the reports of script/bench-card.

python bench_card.py FOLDER
"""

import json
import sys
from pathlib import Path

# Goals for a picture's wall time on a card of 2026, in milliseconds.
GOALS = {
    ("chair-256", "orbit"): 0.40,
    ("chair-256", "light-drag"): 1.5,
    ("chair-256", "tf-edit"): 3,
    ("chair-512", "light-drag"): 8,
    ("chair-512", "tf-edit"): 12,
    ("cloud-512", "light-drag"): 13,
    ("cloud-512", "tf-edit"): 32,
    ("cloud-1024", "light-drag"): 28,
    ("chair-4k", "orbit"): 7.5,
    ("chair-first-look", "light-drag"): 22,
    ("chair-all-light", "light-drag"): 22,
}


def shown(number):
    return "–" if number is None else f"{number:.3g}"


def median(case, clock):
    value = case.get(clock)
    return value["median"] if isinstance(value, dict) else value


def bench_rows(folder):
    for path in sorted(folder.glob("*.*.json")):
        scene, name = path.stem.split(".", 1)
        if name == "start":
            continue
        report = json.loads(path.read_text())
        for case in (case for case in report["cases"] if case["name"] == name):
            card = [ms for ms in case["gpu_ms"].values() if ms is not None]
            goal = GOALS.get((scene, name))
            wall = median(case, "wall_ms")
            verdict = "" if goal is None else "reached" if wall <= goal else f"{wall / goal:.2f} × the goal"
            yield [scene, name, *map(shown, [wall, median(case, "host_ms"), sum(card) if card else None, goal]), verdict]
        for ratio, found in report["ratios"].items():
            if isinstance(found, dict):
                measured, bound = found["measured"], found.get("bound")
                verdict = "" if bound is None else "reached" if measured <= bound else "missed"
                yield [scene, f"{ratio} (ratio)", shown(measured), "", "", shown(bound), verdict]


def start_rows(folder):
    for path in sorted(folder.glob("*.start.json")):
        report = json.loads(path.read_text())
        stages = ", ".join(f"{stage} {ms:.0f}" for stage, ms in report["to_picture_ms"].items()
                           if stage != "parallel" and ms >= 0.5)
        yield f"{path.stem.removesuffix('.start')}: {stages} ms"


def main(folder):
    reports = [json.loads(path.read_text()) for path in folder.glob("*.json")]
    adapters = {f"{report['adapter']}, {report['driver']}" for report in reports}
    print("; ".join(sorted(adapters)))
    rows = [["scene", "case", "wall ms", "host ms", "card ms", "goal", ""], *bench_rows(folder)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    print("\nfrom the start of the program to a picture in its file, files and shaders cached:")
    for line in start_rows(folder):
        print(line)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
