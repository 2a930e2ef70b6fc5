// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace parkade {

/// Lines that meet in a T or an L look like arrows to a network that sees little around them. Paint
/// labelled arrow becomes slot line where the network holds that nearly as likely (4.5 log-odds
/// less on average), where it hangs together with a slot's line or runs both ways, and where it is
/// about as wide everywhere: an arrow's head is wider than its shaft. slot_line: as BevLabels has
/// it; empty: nothing happens. labels: CV_8UC1, SemanticClass.
void tellStrokesFromArrows(const cv::Mat& slot_line, double metres_per_px, cv::Mat& labels);

/// Lane lines end where slots begin: paint labelled lane line that touches a slot's line, and that
/// the network holds nearly as likely for one (4 log-odds less on average), becomes slot line; so
/// does what has the shape of a T or an L, which lane lines rarely make (3 less). slot_line,
/// labels: as above.
void tellSlotsFromLanes(const cv::Mat& slot_line, double metres_per_px, cv::Mat& labels);

/// A network often mixes up what a stroke of paint is for part of its length: the last decimetres
/// of a slot's line become a lane line's, and the corner is lost. Gives each small piece of paint
/// (up to a tenth of a square metre) that touches a piece of other paint, at least twice as large,
/// the class of the largest such piece. labels: CV_8UC1, SemanticClass.
void uniteStrokes(cv::Mat& labels, double metres_per_px);

}  // namespace parkade
