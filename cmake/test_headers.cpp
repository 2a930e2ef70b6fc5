// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// What the precompiled headers of the tests are compiled with (ParkadeRoom.cmake).
