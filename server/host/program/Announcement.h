// Prints and writes a server's address and how to join it, at its start.
#pragma once

#include <string>
#include <vector>

namespace naiad {

class HostEndpoint;
class ListenError;
struct HostOptions;

/// Hints about the settings that let more or fewer players in; one sentence each.
struct AccessHints {
  std::string how_to_open;
  std::string how_to_restrict;
};

/// Returns lines for the player: "Join from this machine with: dfclient naiad://…", how to join from
/// elsewhere, by ssh and in a browser if the options name these, and the address on which it listens.
std::vector<std::string> joinInstructions(const HostEndpoint& endpoint, const HostOptions& options,
                                          const AccessHints& openness);
/// Returns the error's text. If a server whose control socket this user may use already listens on the port,
/// the text says how to join it.
std::string listenErrorText(const ListenError& error, const HostOptions& options);
/// Returns the QR code if HostOptions::qr is set, or a line that says why there is none; otherwise empty.
std::vector<std::string> qrLines(const HostOptions& options);
/// Writes HostOptions::port_file and join_file, if set, each atomically. Throws std::runtime_error.
void writeEndpointFiles(const HostOptions& options, const HostEndpoint& endpoint);

}  // namespace naiad
