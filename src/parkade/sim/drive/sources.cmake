# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
set(DRIVE_SOURCES
    drive/imu_model.cpp drive/path.cpp drive/speed_profile.cpp drive/vehicle_motion.cpp)
set(DRIVE_TESTS drive/imu_model_test.cpp drive/path_test.cpp drive/speed_profile_test.cpp
                drive/vehicle_motion_test.cpp)
