# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
list(APPEND SIM_PRIVATE_DEPS opencv_imgproc)
set(WORLD_SOURCES
    garage.cpp
    world/aisle_graph.cpp
    world/aisle_paint.cpp
    world/arrows.cpp
    world/car_mesh.cpp
    world/coverage.cpp
    world/fittings.cpp
    world/floor_build.cpp
    world/floor_surface.cpp
    world/generate.cpp
    world/grids.cpp
    world/layout.cpp
    world/mesh_builder.cpp
    world/noise_texture.cpp
    world/paint_layer.cpp
    world/palette.cpp
    world/parked_cars.cpp
    world/person_mesh.cpp
    world/pillars.cpp
    world/plan_image.cpp
    world/polygon.cpp
    world/scene_builder.cpp
    world/services.cpp
    world/shell.cpp
    world/signs.cpp
    world/slot_paint.cpp
    world/stroke_font.cpp
    world/style.cpp)
set(WORLD_TESTS
    world/car_mesh_test.cpp
    world/floor_surface_test.cpp
    world/generate_test.cpp
    world/person_mesh_test.cpp
    world/scene_builder_test.cpp)
