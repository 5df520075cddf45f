// Records what a channel reports to its owner.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shared/net/base/Channel.h"

namespace naiad::test {

/// Records the frames and the end of a channel. Must outlive the channel.
struct Recorder {
  std::vector<std::string> frames;
  std::optional<CloseReason> closed;
  int closings = 0;

  ReliableChannel::Callbacks callbacks() {
    return {[this](std::string_view frame) { frames.emplace_back(frame); },
            [this](CloseReason reason) {
              closed = reason;
              ++closings;
            }};
  }
};

}  // namespace naiad::test
