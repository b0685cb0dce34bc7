"""Proof that each check can fail: a small sound house, and for every check the fault that it must find, and nothing more."""

import os
import tempfile

import checks
import rules
from tree import Tree

HOUSE = {
    "core/vec.hpp": "// Vectors.\n#pragma once\n",
    "solver/step.hpp": '// Steps (key good2004).\n#pragma once\n#include "core/vec.hpp"\n',
    "solver/step.cpp": '#include "solver/step.hpp"\n// std::cout in a comment, 1\'000 and "printf(" in a text are fine\nconst char* t = "std::cerr << CGAL/";\n',
    "meshes/repair_cgal.cpp": "#include <CGAL/Surface_mesh.h>\n",
    "apps/main.cpp": '#include <CLI/CLI.hpp>\n#include "solver/step.hpp"\nint main() { printf("x"); }\n',
    "solver/CMakeLists.txt": "pelletlab_room(solver\n  SOURCES step.cpp\n  DEPENDS core)\n",
    "docs/references.bib": "@article{good2004,\n}\n",
}

# check → (file, text, part of the message)
FAULTS = {
    "every_folder_with_sources_is_a_known_room": [("attic/a.cpp", "int a;\n", "'attic' is no room")],
    "include_arrows_are_allowed": [
        ("solver/wall.cpp", '\n#include "meshes/check.hpp"\n', "solver/wall.cpp:2: solver may not include meshes"),
        ("core/back.hpp", '// B.\n#pragma once\n#include "solver/step.hpp"\n', "core may not include solver"),
    ],
    "link_arrows_are_allowed": [
        ("solver/CMakeLists.txt", "pelletlab_room(solver\n  SOURCES step.cpp\n  DEPENDS core meshes)\n", "solver may not link meshes"),
        ("solver/CMakeLists.txt", "target_link_libraries(pelletlab_solver PRIVATE pelletlab::meshes)\n", "solver may not link meshes"),
        ("solver/fast/CMakeLists.txt", "pelletlab_room(solver_fast\n  SOURCES a.cpp\n  DEPENDS core meshes_read\n  PRIVATE_LIBRARIES x)\n", "may not link meshes"),
    ],
    "rooms_form_no_cycle": [("core/back.hpp", '// B.\n#pragma once\n#include "solver/step.hpp"\n', "solver -> core -> solver")],
    "heavy_headers_stay_in_their_files": [
        ("meshes/repair.cpp", "#include <CGAL/Surface_mesh.h>\n", "*_cgal.cpp"),
        ("meshes/grid.hpp", "// G.\n#pragma once\n  #  include <openvdb/openvdb.h>\n", "meshes/grid.hpp:3"),
        ("solver/wall_cgal.cpp", "#include <embree3/rtcore.h>\n", "*_embree.cpp"),
        ("meshes/read.cpp", "#include <assimp/scene.h>\n", "*_assimp.cpp"),
        ("solver/save.cpp", "#include <hdf5.h>\n", "*_hdf5.cpp"),
    ],
    "headers_stay_at_home": [
        ("solver/read.cpp", "#include <toml++/toml.h>\n", "only in io/"),
        ("solver/read.cpp", "#include <CLI/CLI.hpp>\n", "only in apps/"),
        ("solver/read.cpp", "#include <thread>\n", "only in core/"),
        ("solver/read.cpp", "#include <random>\n", "only in core/"),
    ],
    "only_apps_print": [
        ("solver/talk.cpp", "void f() {\n    std::cout << 1;\n}\n", "solver/talk.cpp:2"),
        ("solver/talk.cpp", "void f() { printf(\"a\"); }\n", "only apps/ may print"),
        ("solver/talk.cpp", "void f() { std::fprintf(stderr, \"a\"); }\n", "only apps/ may print"),
        ("solver/talk.cpp", "void f() { fmt::print(\"a\"); }\n", "only apps/ may print"),
    ],
    "files_are_short": [("solver/long.cpp", "int a;\n" * (rules.LINES_MAX + 1), "one idea a file")],
    "no_network_at_configure_time": [
        ("cmake/Get.cmake", "include(FetchContent)\n", "must not fetch"),
        ("meshes/CMakeLists.txt", "file( DOWNLOAD https://example.org/x y)\n", "must not fetch"),
        ("cmake/Get.cmake", "ExternalProject_Add(x)\n", "must not fetch"),
    ],
    "no_paths_of_a_machine": [
        ("docs/a.md", "see /" + "home/ann/pellets\n", "path of one machine"),
        ("solver/a.cpp", 'auto f = "/' + 'tmp/x.stl";\n', "solver/a.cpp:1"),
    ],
    "headers_have_a_guard_and_a_first_sentence": [
        ("solver/a.hpp", "// A.\nint a;\n", "no #pragma once"),
        ("solver/a.hpp", "#pragma once\nint a;\n", "in a sentence"),
    ],
    "links_of_documents_lead_somewhere": [
        ("docs/a.md", "[here](references.bib) [there](https://example.org) [folder](../core/)\n![gone](gone.png)\n", "docs/a.md:2"),
    ],
    "references_are_listed": [("solver/a.hpp", "// A formula (key lost1999).\n#pragma once\n", "'lost1999'")],
}


def _house_with(extra):
    folder = tempfile.TemporaryDirectory(prefix="pelletlab-house-")
    for name, text in {**HOUSE, **extra}.items():
        path = os.path.join(folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(text)
    return folder


def run():
    """Returns what is wrong with the checks themselves."""
    wrong = []
    with _house_with({}) as folder:
        for name, check in checks.ALL.items():
            for fault in check(Tree(folder)):
                wrong.append(f"{name} finds a fault in a sound house: {fault}")
    for name in checks.ALL:
        if name not in FAULTS:
            wrong.append(f"{name} has no fault in tests/architecture/self_test.py that shows that it can fail")
    for name, faults in FAULTS.items():
        for file, text, message in faults:
            with _house_with({file: text}) as folder:
                found = checks.ALL[name](Tree(folder))
            if len(found) != 1 or message not in found[0]:
                wrong.append(f"{name}: expected one fault with «{message}» for {file}, got {found}")
    return wrong
