# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
list(APPEND SIM_PRIVATE_DEPS opencv_imgproc nlohmann_json::nlohmann_json)
set(WORLD_SOURCES
    world/agent_motion.cpp
    world/agent_tracks.cpp
    world/agents.cpp
    garage.cpp
    scene.cpp
    world/aisle_graph.cpp
    world/aisle_paint.cpp
    world/arrows.cpp
    world/car_hull.cpp
    world/car_mesh.cpp
    world/car_profile.cpp
    world/coverage.cpp
    world/fittings.cpp
    world/floor_build.cpp
    world/floor_kernel.cpp
    world/floor_maps.cpp
    world/floor_surface.cpp
    world/garage_json_read.cpp
    world/garage_json_write.cpp
    world/generate.cpp
    world/grids.cpp
    world/layout.cpp
    world/layout_build.cpp
    world/mesh_builder.cpp
    world/noise_texture.cpp
    world/one_way.cpp
    world/paint_layer.cpp
    world/palette.cpp
    world/parked_cars.cpp
    world/person_mesh.cpp
    world/pillars.cpp
    world/plan_image.cpp
    world/polygon.cpp
    world/quad_texture.cpp
    world/scene_builder.cpp
    world/services.cpp
    world/shell.cpp
    world/signs.cpp
    world/slot_paint.cpp
    world/stroke_font.cpp
    world/style.cpp)
# Fused multiply-add would make pictures differ between instruction sets.
set_source_files_properties(world/floor_kernel.cpp PROPERTIES
                            COMPILE_OPTIONS "-ffp-contract=off;-fno-math-errno;-fno-trapping-math")
set(WORLD_TESTS
    world/agents_test.cpp
    world/car_mesh_test.cpp
    world/floor_surface_test.cpp
    world/garage_json_test.cpp
    world/generate_test.cpp
    world/one_way_test.cpp
    world/person_mesh_test.cpp
    world/scene_builder_test.cpp)
