// Tells people and scripts, at a server's start, its address and how to join.
#pragma once

#include <string>
#include <vector>

namespace naiad {

class HostEndpoint;
struct HostOptions;

/// Which setting lets more or fewer players in: a sentence each.
struct Openness {
  std::string how_to_open;
  std::string how_to_restrict;
};

/// "Join from this machine with: dfclient naiad://…", how from elsewhere, by ssh and on a page as far as the
/// options name these, and what is listened on.
std::vector<std::string> howToJoin(const HostEndpoint& endpoint, const HostOptions& options,
                                   const Openness& openness);
/// The QR code that HostOptions::qr asks for, or why there is none; empty if it does not.
std::vector<std::string> qrLines(const HostOptions& options);
/// HostOptions::port_file and join_file, if they are asked for: each replaced in one step. Throws
/// std::runtime_error if one cannot be written.
void writeWhereabouts(const HostOptions& options, const HostEndpoint& endpoint);

}  // namespace naiad
