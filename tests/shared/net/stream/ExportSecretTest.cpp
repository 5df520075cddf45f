// Both ends of an encrypted channel export equal secrets, and no other channel has them.
#include <gtest/gtest.h>

#include <set>

#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {
namespace {

constexpr std::string_view kLabel = "EXPERIMENTAL-naiad-datagram";

/// Expects secrets that are equal at both ends and different for each use.
void expectSecrets(const ReliableChannel& near, const ReliableChannel& far, std::set<std::string>& seen) {
  for (const auto& [label, text, bytes] :
       {std::tuple(kLabel, "one", 88), std::tuple(kLabel, "two", 88), std::tuple(kLabel, "", 88),
        std::tuple(std::string_view("EXPERIMENTAL-other"), "one", 88), std::tuple(kLabel, "one", 32)}) {
    const std::string secret = near.exportSecret(label, text, static_cast<std::size_t>(bytes));
    EXPECT_EQ(secret.size(), static_cast<std::size_t>(bytes));
    EXPECT_EQ(secret, near.exportSecret(label, text, static_cast<std::size_t>(bytes)));
    EXPECT_EQ(secret, far.exportSecret(label, text, static_cast<std::size_t>(bytes)));
    EXPECT_TRUE(seen.insert(secret.substr(0, 32)).second) << label << ' ' << text << ' ' << bytes;
  }
}

TEST(ExportSecret, BothTlsEndsShareAUniqueSecret) {
  asio::io_context context;
  std::set<std::string> seen;
  for (int connection = 0; connection < 2; ++connection) {
    const ChannelPair pair(context, Kind::kTls);
    expectSecrets(*pair.near, *pair.far, seen);
  }
}

TEST(ExportSecret, IsEmptyWithoutEncryptionAndAfterTheEnd) {
  asio::io_context context;
  const ChannelPair plain(context, Kind::kPlain);
  EXPECT_EQ(plain.near->exportSecret(kLabel, "one", 32), "");
  ChannelPair pair(context, Kind::kTls);
  Recorder recorder;
  pair.far->start(recorder.callbacks());
  pair.near.reset();
  EXPECT_TRUE(runUntil(context, [&] { return recorder.closed.has_value(); }));
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
  EXPECT_EQ(pair.far->exportSecret(kLabel, "one", 32), "");
}

}  // namespace
}  // namespace naiad::test
