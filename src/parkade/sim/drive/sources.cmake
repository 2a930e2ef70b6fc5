# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
include(drive/rig_presets.cmake)
list(APPEND SIM_PRIVATE_DEPS opencv_core opencv_imgproc)
set(DRIVE_SOURCES
    drive/clearance.cpp drive/frame_renderer.cpp drive/imu_model.cpp drive/lane.cpp drive/path.cpp
    drive/preview.cpp drive/rig_presets.cpp drive/routes.cpp drive/sim_source.cpp
    drive/simulation.cpp drive/spec.cpp
    drive/speed_profile.cpp drive/vehicle_motion.cpp drive/way.cpp ${RIG_PRESETS_SOURCE})
set(DRIVE_TESTS drive/frame_renderer_test.cpp drive/imu_model_test.cpp drive/label_images_test.cpp drive/path_test.cpp drive/routes_test.cpp
                drive/sim_source_test.cpp drive/spec_test.cpp drive/speed_profile_test.cpp
                drive/vehicle_motion_test.cpp)
