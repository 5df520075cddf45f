// The lines of a file of known servers, in memory. KnownServers.h says what is in them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// ASCII letters only: host names as DNS compares them.
std::string lowerCase(std::string text);

class PinLines {
 public:
  explicit PinLines(std::string_view content);
  std::string content() const;

  /// The pin of `server` ("host:port", lower case): the last one, if there are several.
  std::optional<Fingerprint> find(std::string_view server) const;
  /// Make it the only one. Other lines stay as they are.
  void set(std::string_view server, const Fingerprint& key);
  /// Numbers, from 1, of the lines that are neither a pin nor a comment.
  std::vector<std::size_t> malformed() const;

 private:
  struct Line {
    std::string text;
    std::string server;  // empty: no pin
    std::optional<Fingerprint> key;
  };
  static Line parse(std::string_view text);

  std::vector<Line> lines_;
};

}  // namespace naiad
