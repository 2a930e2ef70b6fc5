// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/sim_truth.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "parkade/io/file.hpp"
#include "parkade/io/sequence_writer.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/sim/world/garage_json.hpp"

namespace parkade::cli {
Status writeTruth(const sim::Simulation& simulation, const std::string& sequence) {
  const std::string truth = joinPath(sequence, "truth");
  Status made = makeFolders(truth);
  if (!made) return made;
  Trajectory poses;
  std::vector<GroundTruthState> states;
  for (const sim::TruthState& state : simulation.truth()) {
    poses.push_back({state.t_ns, state.T_world_vehicle});
    states.push_back({state.t_ns, state.T_world_vehicle, state.velocity_world, state.gyro_bias,
                      state.accel_bias});
  }
  Status status = writeTrajectory(joinPath(truth, "trajectory.tum"), poses, TrajectoryFormat::kTum);
  if (status) status = writeGroundTruth(sequence, states);
  if (status) status = writeRig(simulation.trueRig(), joinPath(truth, "rig.yaml"));
  if (status) status = sim::writeGarageTruth(simulation.garage(), joinPath(truth, "garage.json"));
  return status;
}

Status writeAgents(const sim::Simulation& simulation, const sim::Scene& scene,
                   const std::string& sequence) {
  std::string text =
      "#timestamp [ns],id,class,x [m],y [m],z [m],qw [],qx [],qy [],qz [],length [m],width [m],"
      "height [m]\n";
  const auto out = std::back_inserter(text);
  for (const TimeNs t_ns : simulation.frameTimes()) {
    for (const sim::MovingObject& object : scene.moving) {
      const SE3 pose = object.pose(toSeconds(t_ns - sim::kSimStartNs));
      const Eigen::Vector3d& p = pose.translation();
      const Eigen::Quaterniond& q = pose.rotation().quaternion();
      fmt::format_to(out, "{},{},{},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{},{},{}\n",
                     t_ns, object.instance,
                     kSemanticClassNames[static_cast<std::size_t>(object.label)], p.x(), p.y(),
                     p.z(), q.w(), q.x(), q.y(), q.z(), object.box_size.x(), object.box_size.y(),
                     object.box_size.z());
    }
  }
  return writeFileAtomic(joinPath(sequence, "truth/agents.csv"), text);
}

std::string specText(const sim::SimSpec& spec) {
  sim::SimSpec fixed = spec;
  fixed.threads = 1;  // the bytes do not depend on it
  if (spec.parkedSeed() == spec.garage_seed) fixed.parked_seed = -1;
  std::string text = dumpOptions(asOptions(fixed));
  // As before there were these options: recordings of that time are still the same.
  const auto leave_out = [&text](const std::string& line) {
    if (const std::size_t at = text.find(line); at != std::string::npos) {
      text.erase(at, line.size());
    }
  };
  if (spec.one_way == 0.0) leave_out("one_way: 0\n");
  if (fixed.parked_seed == -1) leave_out("parked_seed: -1\n");
  if (spec.first_zone == "A") leave_out("first_zone: 'A'\n");
  if (spec.readout_ms == 0.0) leave_out("readout_ms: 0\n");
  return text;
}

}  // namespace parkade::cli
