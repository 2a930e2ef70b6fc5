# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
set(WORLD_SOURCES
    garage.cpp
    world/car_mesh.cpp
    world/coverage.cpp
    world/floor_surface.cpp
    world/generate.cpp
    world/grids.cpp
    world/layout.cpp
    world/mesh_builder.cpp
    world/noise_texture.cpp
    world/paint_layer.cpp
    world/person_mesh.cpp
    world/polygon.cpp
    world/style.cpp)
set(WORLD_TESTS
    world/car_mesh_test.cpp
    world/floor_surface_test.cpp
    world/generate_test.cpp
    world/person_mesh_test.cpp)
