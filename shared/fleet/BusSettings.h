// Which bus a fleet has, and how to reach it.
#pragma once

#include <string>
#include <vector>

namespace naiad {

struct BusSettings {
  std::string url;          ///< nats://HOST:PORT or tls://HOST:PORT
  std::string credentials;  ///< file of a user's token and seed; empty: none
  std::string authorities;  ///< file of certificates (PEM) that the bus's is signed with; empty: the system's
  std::vector<std::string> subjects = {};  ///< to listen to; "naiad.presence.*" are all with one word there

  bool isEncrypted() const { return url.starts_with("tls://"); }
};

/// Returns why there can be no such bus: a sentence; empty if there can. Whether it can be reached shows
/// later.
std::string busComplaint(const BusSettings& settings);

}  // namespace naiad
