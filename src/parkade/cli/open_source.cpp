// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/open_source.hpp"

#include <fmt/core.h>

#include <utility>

#include "parkade/io/sequence_reader.hpp"

namespace parkade::cli {
namespace {

Result<OpenedSource> openFolder(const SourceRequest& request) {
  SequenceReaderOptions options;
  options.cameras = request.cameras;
  options.gray = request.gray;
  options.tolerate_stamps = request.tolerate_stamps;
  options.start_s = request.start_s;
  options.duration_s = request.duration_s;
  options.decode_threads = request.decode_threads;
  auto reader = SequenceReader::open(request.spec, options);
  if (!reader) return reader.error();
  OpenedSource opened;
  opened.rig = (*reader)->rig();
  opened.source = std::move(*reader);
  return opened;
}

Result<OpenedSource> openSimulator(const SourceRequest& request) {
  return Error{fmt::format(
      "{}: the simulator cannot be run from directly in this build; write a sequence with 'parkade "
      "sim --out SEQ' and give SEQ",
      request.spec)};
}

}  // namespace

Result<OpenedSource> openSource(const SourceRequest& request) {
  return request.spec.starts_with("sim:") ? openSimulator(request) : openFolder(request);
}

}  // namespace parkade::cli
