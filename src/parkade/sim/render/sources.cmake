# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
find_package(embree 3.13 REQUIRED GLOBAL)
list(APPEND SIM_PRIVATE_DEPS embree opencv_core)
set(RENDER_SOURCES
    render/bake_bounces.cpp
    render/bake_places.cpp
    render/bake_probes.cpp
    render/camera_places.cpp
    render/direct_light.cpp
    render/embree.cpp
    render/floor_rays_kernel.cpp
    render/floor_shading.cpp
    render/frame.cpp
    render/frame_edges.cpp
    render/lamp_map.cpp
    render/light_bake.cpp
    render/light_grids.cpp
    render/moment.cpp
    render/moment_kernel.cpp
    render/openness.cpp
    render/overhead.cpp
    render/parallel.cpp
    render/ray_table.cpp
    render/reflection.cpp
    render/render_mesh.cpp
    render/renderer.cpp
    render/sensor_kernel.cpp
    render/sensor_model.cpp
    render/shading.cpp
    render/shading_tables.cpp
    render/sight_labels.cpp
    render/texture.cpp
    render/tile_tracer.cpp
    render/tracer.cpp
    render/truth.cpp)
set(RENDER_TESTS
    render/garage_exactness_test.cpp
    render/geometry_exactness_test.cpp
    render/parallel_test.cpp
    render/reflection_test.cpp
    render/renderer_test.cpp
    render/sensor_model_test.cpp
    render/tracer_test.cpp)
