"""One function a rule: check_<name>(tree) returns a list of faults, «file:line: what is wrong and what to do»."""

import os
import re

import rules


def _room_files(tree):
    return [f for f in tree.sources() if f.split("/")[0] in tree.rooms()]


def _arrows(tree):
    """(room, other room, file, line) for every #include of another room's header."""
    for file in _room_files(tree):
        room = file.split("/")[0]
        for line, header in tree.includes(file):
            other = header.split("/")[0]
            if "/" in header and other in tree.rooms() and other != room:
                yield room, other, file, line


def check_every_folder_with_sources_is_a_known_room(tree):
    known = set(rules.ALLOWED) | {"tests", "benchmarks", "fuzz", "examples", "docs"}
    return [f"{file}:1: '{file.split('/')[0]}' is no room: give it a row in tests/architecture/rules.py and in docs/architecture.md"
            for file in tree.sources() if "/" in file and file.split("/")[0] not in known]


def check_include_arrows_are_allowed(tree):
    return [f"{file}:{line}: {room} may not include {other} (allowed: {', '.join(sorted(rules.ALLOWED.get(room, ()))) or 'nothing'})"
            for room, other, file, line in _arrows(tree) if other not in rules.ALLOWED.get(room, ())]


def check_link_arrows_are_allowed(tree):
    """The same rule for targets: DEPENDS of pelletlab_room(), and pelletlab::<room> anywhere in a CMakeLists.txt of a room."""
    faults, rooms = [], set(tree.rooms())

    def room_of(target):  # «shapegen_formats» is a part of shapegen
        return target if target in rooms else target.split("_")[0]

    for file in tree.files():
        room = file.split("/")[0]
        if room not in rooms or not file.endswith("CMakeLists.txt"):
            continue
        text = re.sub(r"#.*", "", tree.text(file))
        linked = set(re.findall(r"\bpelletlab(?:::|_)(\w+)", text))
        for words in re.findall(r"\bDEPENDS\b([^)]*?)(?=PRIVATE_LIBRARIES|SOURCES|\))", text):
            linked |= set(words.split())
        for other in sorted({room_of(target) for target in linked} & rooms - {room} - rules.ALLOWED.get(room, set())):
            faults.append(f"{file}:1: {room} may not link {other}")
    return faults


def check_rooms_form_no_cycle(tree):
    graph = {}
    for room, other, file, line in _arrows(tree):
        graph.setdefault(room, {}).setdefault(other, f"{file}:{line}")
    faults, done = [], set()

    def visit(room, path):
        if room in path:
            ring = path[path.index(room):] + [room]
            places = ", ".join(graph[a][b] for a, b in zip(ring, ring[1:]))
            faults.append(f"{places}: rooms in a circle: {' -> '.join(ring)}")
            return
        if room in done:
            return
        for other in sorted(graph.get(room, {})):
            visit(other, path + [room])
        done.add(room)

    for room in sorted(graph):
        visit(room, [])
    return faults


def check_heavy_headers_stay_in_their_files(tree):
    faults = []
    for file in _room_files(tree):
        for line, header in tree.includes(file):
            for prefix, ending in rules.HEAVY.items():
                if header.startswith(prefix) and not (file.endswith(f"{ending}.cpp") or file.endswith(f"{ending}.hpp")):
                    faults.append(f"{file}:{line}: <{header}> belongs into a file named *{ending}.cpp")
    return faults


def check_headers_stay_at_home(tree):
    faults = []
    for file in _room_files(tree):
        for line, header in tree.includes(file):
            for prefix, homes in rules.AT_HOME.items():
                matches = header.startswith(prefix) if prefix.endswith("/") else header == prefix
                if matches and file.split("/")[0] not in homes:
                    faults.append(f"{file}:{line}: <{header}> only in {', '.join(sorted(homes))}/")
    return faults


def check_only_apps_print(tree):
    faults = []
    for file in _room_files(tree):
        if file.startswith("apps/"):
            continue
        for number, line in enumerate(tree.code(file).split("\n"), 1):
            if re.search(rules.PRINTING, line):
                faults.append(f"{file}:{number}: only apps/ may print; report through a result, an Error or a ProgressSink")
    return faults


def check_files_are_short(tree):
    faults = []
    for file in tree.files():
        if not (file.endswith((".hpp", ".cpp", ".py", ".cmake", "CMakeLists.txt")) or file.startswith(("scripts/", ".ci/"))):
            continue
        lines = tree.text(file).count("\n")
        if lines > rules.LINES_MAX:
            faults.append(f"{file}:{lines}: {lines} lines, more than {rules.LINES_MAX}: one idea a file")
        elif lines > rules.LINES_WARN:
            print(f"warning: {file} has {lines} lines (more than {rules.LINES_WARN})")
    return faults


def check_no_network_at_configure_time(tree):
    faults = []
    for file in tree.files():
        if file.endswith((".cmake", "CMakeLists.txt", ".cmake.in")):
            for number, line in enumerate(tree.text(file).split("\n"), 1):
                if re.search(rules.NETWORK, re.sub(r"#.*", "", line)):
                    faults.append(f"{file}:{number}: CMake must not fetch anything; add the package to scripts/apt-packages.txt")
    return faults


def check_no_paths_of_a_machine(tree):
    faults = []
    for file in tree.files():
        if file.endswith((".stl", ".png", ".h5", ".obj", ".ply")):
            continue
        for number, line in enumerate(tree.text(file).split("\n"), 1):
            found = re.search(rules.MACHINE_PATHS, line)
            if found:
                faults.append(f"{file}:{number}: path of one machine: {found.group(0)}")
    return faults


def check_headers_have_a_guard_and_a_first_sentence(tree):
    faults = []
    for file in _room_files(tree):
        if not file.endswith(".hpp"):
            continue
        text = tree.text(file)
        if "#pragma once" not in text:
            faults.append(f"{file}:1: no #pragma once")
        if not text.startswith("// "):
            faults.append(f"{file}:1: the first line should say in a sentence what the header is for")
    return faults


def check_references_are_listed(tree):
    """Every «key name2004» of a header or source is in docs/references.bib."""
    bibliography = tree.text("docs/references.bib") if "docs/references.bib" in tree.files() else ""
    keys = set(re.findall(r"^@\w+\{([^,\s]+),", bibliography, re.MULTILINE))
    faults = []
    for file in _room_files(tree):
        for number, line in enumerate(tree.text(file).split("\n"), 1):
            for key in re.findall(r"\bkeys? ((?:[a-z_]+\d{4}[a-z]?(?:, | and )?)+)", line):
                for one in re.findall(r"[a-z_]+\d{4}[a-z]?", key):
                    if one not in keys:
                        faults.append(f"{file}:{number}: source '{one}' is not in docs/references.bib")
    return faults


def check_links_of_documents_lead_somewhere(tree):
    """Relative links and pictures in Markdown files."""
    faults, known = [], set(tree.files())
    folders = {os.path.dirname(file) for file in known}
    for file in tree.files():
        if not file.endswith(".md"):
            continue
        for number, line in enumerate(tree.text(file).split("\n"), 1):
            for target in re.findall(r"\]\(([^)\s#]+)[^)]*\)", re.sub(r"`[^`]*`", "", line)):
                path = os.path.normpath(os.path.join(os.path.dirname(file), target))
                if not re.match(r"[a-z]+:", target) and path not in known and path not in folders:
                    faults.append(f"{file}:{number}: the link leads nowhere: {target}")
    return faults


ALL = {name[len("check_"):]: function for name, function in globals().items() if name.startswith("check_")}
