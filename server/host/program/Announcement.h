// Tells people and scripts, at a server's start, its address and how to join.
#pragma once

#include <string>
#include <vector>

namespace naiad {

class Host;
struct HostOptions;

/// Which setting lets more or fewer players in: a sentence each.
struct Openness {
  std::string how_to_open;
  std::string how_to_restrict;
};

/// "Join from this machine with: dfclient …", how from elsewhere, and what is listened on.
std::vector<std::string> howToJoin(const Host& host, const HostOptions& options, const Openness& openness);
/// HostOptions::port_file and join_file, if they are asked for: each replaced in one step. Throws
/// std::runtime_error if one cannot be written.
void writeWhereabouts(const HostOptions& options, const Host& host);

}  // namespace naiad
