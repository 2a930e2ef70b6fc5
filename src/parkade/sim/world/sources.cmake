# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
set(WORLD_SOURCES garage.cpp world/generate.cpp world/grids.cpp world/layout.cpp world/polygon.cpp
                  world/style.cpp)
set(WORLD_TESTS world/generate_test.cpp)
