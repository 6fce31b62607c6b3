// The source of the precompiled header (see the top CMakeLists.txt): it has none of its own.
