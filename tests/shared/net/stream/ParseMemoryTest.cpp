// Memory used by a message within its size limit. Protobuf can make an object of two bytes, so the limit of a
// frame must be small enough for the worst content.
#include <gtest/gtest.h>
#include <malloc.h>

#include <string>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

/// Returns the heap bytes that a parsed message holds.
template <class Message>
std::size_t heapOf(const std::string& bytes) {
  const auto used = [] {
    const auto info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const std::size_t before = used();
  Message message;
  static_cast<void>(message.ParseFromString(bytes));
  return used() - before;
}

/// Returns a message whose field `outer` (its key) repeats `part` as often as it fits.
std::string filled(char outer, const std::string& part, std::size_t limit) {
  const std::size_t room = limit - 4;  // space without the outer key and its length
  std::string inner;
  while (inner.size() + part.size() <= room) inner += part;
  std::string bytes(1, outer);
  for (std::size_t size = inner.size();; size >>= 7) {
    bytes.push_back(static_cast<char>((size & 0x7F) | (size > 0x7F ? 0x80 : 0)));
    if (size <= 0x7F) break;
  }
  return bytes + inner;
}

class ParseMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "a sanitizer's heap does not count this way";
  }
};

TEST_F(ParseMemory, LargestHelloFitsTheMemoryLimit) {
  // One-byte numbers in an unpacked list of words, repeated empty texts, a text field.
  for (const char* part : {"\x48\x01", "\x1a\x00", "\x50\x01"}) {
    const std::string bytes = filled('\x0a', std::string(part, 2), kMaxHelloFrame);
    ASSERT_LE(bytes.size(), kMaxHelloFrame);
    EXPECT_LE(heapOf<wire::ClientMessage>(bytes), 16u * 1024) << static_cast<int>(part[0]);
  }
}

TEST_F(ParseMemory, LargestClientMessageFitsTheMemoryLimit) {
  for (const char outer : {'\x12', '\x2a', '\x32', '\x3a'}) {
    const std::string bytes = filled(outer, std::string("\x12\x00", 2), kMaxClientFrame);
    EXPECT_LE(heapOf<wire::ClientMessage>(bytes), 64u * 1024) << static_cast<int>(outer);
  }
}

TEST_F(ParseMemory, LargestServerMessageFitsTheMemoryLimit) {
  // Empty entries take the least bytes, but each becomes an object.
  const std::string players = filled('\x22', std::string("\x0a\x00", 2), kMaxServerFrame);
  const std::size_t heap = heapOf<wire::ServerMessage>(players);
  EXPECT_GT(heap, 100u * 1024) << "this is the dear one";
  EXPECT_LE(heap, 1024u * 1024);
  const std::string sounds = filled('\x4a', std::string("\x0a\x00", 2), kMaxServerFrame);
  EXPECT_LE(heapOf<wire::ServerMessage>(sounds), 1024u * 1024);
  const std::string help = filled('\x12', std::string("\x4a\x00", 2), kMaxServerFrame);
  EXPECT_LE(heapOf<wire::ServerMessage>(help), 1024u * 1024);
}

}  // namespace
}  // namespace naiad
