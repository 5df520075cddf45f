// The programs that the suite `path` compares: how each is started, at both ends of the link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bench::path {

/// Where one run takes place.
struct Place {
  std::string bin;      ///< folder of our programs
  std::string folder;   ///< of this run alone: keys, logs, truth
  std::string address;  ///< of the server, as the client sees it
  std::uint64_t seed = 1;

  std::string file(const std::string& name) const { return folder + "/" + name; }
  std::string truth() const { return file("truth"); }
};

/// Commands for both ends.
struct Peer {
  std::vector<std::string> server;  ///< stays, or leaves something behind that stays
  std::string ready_file;           ///< is there when clients may come
  std::vector<std::string> client;  ///< shows the scene in its terminal
  std::string type_ahead;           ///< to be typed when it starts
  std::string first_keys;           ///< to be typed when the scene is there
  bool arrows = false;              ///< has keys whose effect the client may predict
  bool udp = true;                  ///< false: the link lets no UDP through
};

/// The programs there are, ssh first: by it runs are judged.
const std::vector<std::string>& peerNames();
/// Is it one of ours?
bool isOurs(const std::string& program);
/// Why it cannot be measured here, without blanks; nothing if it can.
std::optional<std::string> notPossibleBecause(const std::string& program);
/// Write what the program needs into the folder, and tell how to start it. Throws std::runtime_error.
Peer preparePeer(const std::string& program, const Place& place);

}  // namespace bench::path
