# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
set(DRIVE_SOURCES drive/path.cpp drive/speed_profile.cpp drive/vehicle_motion.cpp)
set(DRIVE_TESTS drive/path_test.cpp drive/speed_profile_test.cpp drive/vehicle_motion_test.cpp)
