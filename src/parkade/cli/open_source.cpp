// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/open_source.hpp"

#include <fmt/core.h>

#include <utility>

#include "parkade/cli/learned_rig.hpp"
#include "parkade/core/split.hpp"
#include "parkade/io/sequence_reader.hpp"
#ifdef PARKADE_WITH_SIM
#include "parkade/sim/drive/frame_renderer.hpp"
#endif

namespace parkade::cli {
namespace {

Result<OpenedSource> openFolder(const SourceRequest& request) {
  SequenceReaderOptions options;
  if (!request.rig.empty()) {
    const Result<std::string> file = rigFileOf(request.rig);
    if (!file) return file.error();
    options.rig = *file;
  }
  options.cameras = request.cameras;
  options.gray = request.gray;
  options.gray_beside = request.gray_beside;
  options.tolerate_stamps = request.tolerate_stamps;
  options.join_tolerance_ms = request.join_tolerance_ms;
  options.start_s = request.start_s;
  options.duration_s = request.duration_s;
  options.decode_threads = request.decode_threads;
  auto reader = SequenceReader::open(request.spec, options);
  if (!reader) return reader.error();
  OpenedSource opened;
  opened.rig = (*reader)->rig();
  opened.time_offsets_ns = (*reader)->timeOffsets();
  opened.source = std::move(*reader);
  return opened;
}

Result<OpenedSource> openSimulator(const SourceRequest& request) {
#ifdef PARKADE_WITH_SIM
  if (request.start_s > 0.0) {
    return Error{fmt::format("{}: a simulated drive is read from its beginning", request.spec)};
  }
  if (!request.rig.empty()) {
    return Error{fmt::format("{}: --rig is for sequence folders; a simulated drive tells its own",
                             request.spec)};
  }
  sim::SimSourceOptions options;
  options.cameras = request.cameras;
  options.gray = request.gray;
  options.duration = request.duration_s;
  Result<std::unique_ptr<sim::SimSource>> source = sim::openSimSource(request.spec, options);
  if (!source) return source.error();
  OpenedSource opened;
  opened.rig = (*source)->rig();
  opened.time_offsets_ns.assign(opened.rig.cameras.size(), 0);
  opened.source = std::move(source).value();
  return opened;
#else
  return Error{fmt::format("{}: this program was built without the simulator", request.spec)};
#endif
}

}  // namespace

Result<OpenedSource> openSource(const SourceRequest& request) {
  return request.spec.starts_with("sim:") ? openSimulator(request) : openFolder(request);
}

std::string checkCameraNames(const std::string& text) {
  if (!hasEmptyPart(text, ',')) return "";
  return fmt::format("'{}' has an empty name; expected names with commas between them: cam0,cam1",
                     text);
}

}  // namespace parkade::cli
