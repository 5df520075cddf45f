// Records the messages sent over a FakeChannel.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/FakeChannel.h"

namespace naiad::test {

/// Every frame sent must be a Message.
template <class Message>
struct MessageLine : FakeLine {
  MessageLine() {
    on_send = [this](std::string_view frame) {
      Message message;
      EXPECT_TRUE(message.ParseFromArray(frame.data(), static_cast<int>(frame.size())));
      closed ? void(++sent_late) : sent.push_back(std::move(message));
    };
  }
  MessageLine(const MessageLine&) = delete;
  MessageLine& operator=(const MessageLine&) = delete;

  std::vector<Message> sent;  ///< messages sent while the line was open
  std::size_t sent_late = 0;  ///< number of messages sent after close(); a real channel drops them
};

}  // namespace naiad::test
