// toml++ with its assertions off in every build. It asserts, and in release builds of clang even assumes, what damaged text breaks («[ # comment» as a table's
// head): there the right answer is the error that it gives a few lines later.
#pragma once

#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")
