"""The rules of the house that a machine can check; docs/architecture.md tells them to people."""

# Room → rooms whose headers it may include (and whose targets it may link). Everything may use core; apps may use everything.
ALLOWED = {
    "core": set(),
    "meshes": {"core"},
    "shapegen": {"core", "meshes"},
    "solver": {"core"},
    "observables": {"core"},
    "packing": {"core", "meshes", "solver", "observables", "inference"},
    "experiments": {"core", "meshes", "solver", "observables", "packing"},
    "campaign": {"core"},
    "inference": {"core"},
    "diagnosis": {"core", "campaign", "inference"},
    "io": {"core"},
    "report": {"core"},
    "apps": {"core", "meshes", "shapegen", "solver", "observables", "packing", "experiments", "campaign", "inference", "diagnosis", "io", "report"},
}

# A heavy library is included in files with that ending only: it costs seconds a file, and CGAL's flags must not spread.
HEAVY = {
    "CGAL/": "_cgal",
    "openvdb/": "_openvdb",
    "embree3/": "_embree",
    "assimp/": "_assimp",
    "hdf5": "_hdf5",
    "H5": "_hdf5",
}

# Header prefix → the rooms that may include it.
AT_HOME = {
    "toml++/": {"io"},  # only io/ parses files
    "CLI/": {"apps"},  # only apps/ reads the command line
    "iostream": {"apps"},
    # One place knows the thread library and one makes random numbers: the same bits for any thread count depend on it.
    "tbb/": {"core"},
    "oneapi/": {"core"},
    "thread": {"core"},
    "future": {"core"},
    "atomic": {"core"},
    "execution": {"core"},
    "omp.h": {"core"},
    "random": {"core"},
}

# Code (comments and texts removed) that prints: only apps/ may.
PRINTING = r"\bstd::(cout|cerr|clog)\b|\b(std::)?(printf|puts|putchar|perror)\s*\(|\b(std::)?fprintf\s*\(\s*(stdout|stderr)\b|" \
           r"\b(std::)?f(puts|write)\s*\([^;]*\b(stdout|stderr)\b|\bfmt::print\s*\(\s*(\"|stdout|stderr|fmt::)|\bspdlog::"

NETWORK = r"FetchContent|ExternalProject|file\s*\(\s*DOWNLOAD|CPMAddPackage|\b(curl|wget)\s|git\s+clone|https?://[^ )\"]+\.(zip|tar|gz|git)\b"

# Folders of somebody's machine. /tmp by itself and paths of a Debian system are fine.
MACHINE_PATHS = r"(?<![\w.}])/(work|home|Users|mnt|media|root|tmp)/[A-Za-z0-9_.]+|\b[A-Z]:\\\\?[A-Za-z]"

LINES_WARN = 400
LINES_MAX = 500
