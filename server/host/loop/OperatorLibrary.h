// The operators' features: scores, bans, commands, metrics, the server list, the bus of a fleet. They are in
// libdragonfly-ops.so, with the libraries that they need.
#pragma once

#include <memory>
#include <vector>

#include "host/loop/HostPart.h"

namespace naiad {

/// The function that libdragonfly-ops.so exports.
extern "C" using MakeOperatorParts =
    void(const HostAccess& access, std::vector<std::unique_ptr<HostPart>>& parts);
inline constexpr const char* kMakeOperatorParts = "naiad_makeOperatorParts";

/// Returns all parts of a host, in the order in which they are called. Loads the library; if that fails, logs
/// a warning and returns none. Throws what constructors of HostPart throw.
std::vector<std::unique_ptr<HostPart>> makeOperatorParts(const HostAccess& access);

/// Returns why the library cannot be loaded; empty if it can.
std::string operatorPartsProblem();

}  // namespace naiad
