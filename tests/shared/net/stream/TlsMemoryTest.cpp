// Memory limits of a connection that has not logged in: 64 KiB of our own, 192 KiB with OpenSSL's.
#include <gtest/gtest.h>
#include <malloc.h>
#include <openssl/crypto.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "TlsFixture.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

std::atomic<long> openssl_bytes{0};

void* countedMalloc(std::size_t size, const char*, int) {
  void* const memory = std::malloc(size);
  openssl_bytes += static_cast<long>(malloc_usable_size(memory));
  return memory;
}
void countedFree(void* memory, const char*, int) {
  openssl_bytes -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}
void* countedRealloc(void* memory, std::size_t size, const char*, int) {
  openssl_bytes -= static_cast<long>(malloc_usable_size(memory));
  void* const moved = std::realloc(memory, size);
  openssl_bytes += static_cast<long>(malloc_usable_size(moved));
  return moved;
}

// OpenSSL accepts these functions only before it has allocated anything.
const bool counting = CRYPTO_set_mem_functions(countedMalloc, countedRealloc, countedFree) == 1;

struct Heap {
  long openssl = openssl_bytes;
  long all = 0;
  Heap() {
    const auto info = mallinfo2();
    all = static_cast<long>(info.uordblks + info.hblkhd);
  }
};

struct TlsMemoryTest : TlsFixture {
  static constexpr int kConnections = 60;

  void SetUp() override {
    ASSERT_TRUE(counting);
    tls.handshake_timeout = 1h;
    listen();
    accepted.reserve(2 * kConnections);
    sockets.reserve(2 * kConnections);
    finishOne();  // allocates everything that is allocated only once
    accepted.clear();
  }
  /// Prints the bytes per connection since `before` and compares them with the limits.
  void expectSmall(const char* what, const Heap& before) {
    const Heap after;
    const long openssl = (after.openssl - before.openssl) / kConnections;
    const long all = (after.all - before.all) / kConnections;
    std::printf("%s: %ld bytes of OpenSSL's, %ld in all\n", what, openssl, all);
    EXPECT_GT(openssl, 1000);
    EXPECT_LE(openssl, 128 * 1024);
    if (kSanitized) return;  // a sanitizer's heap is not visible in mallinfo2()
    EXPECT_LE(all, 192 * 1024);
    EXPECT_LE(all - openssl, 64 * 1024);
  }
  void finishOne() {
    sockets.push_back(knock());
    RawTls client;
    client.shakeHands(context, sockets.back());
    ASSERT_TRUE(client.done());
    const std::size_t wanted = accepted.size() + 1;
    ASSERT_TRUE(runUntil(context, [&] { return accepted.size() == wanted; }));
  }
  /// Opens all connections. Each sends `bytes` and then waits.
  void sendFromAll(const std::string& bytes) {
    for (int i = 0; i < kConnections; ++i) {
      sockets.push_back(knock());
      if (!bytes.empty()) asio::write(sockets.back(), asio::buffer(bytes));
    }
    EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == kConnections; }));
    for (int i = 0; i < 2 * kConnections; ++i) runReady(context);
  }

  std::vector<tcp::socket> sockets;
};

TEST_F(TlsMemoryTest, IdleConnectionUsesLittleMemory) {
  const Heap before;
  sendFromAll("");
  expectSmall("idle", before);
}

TEST_F(TlsMemoryTest, UnfinishedHelloUsesLittleMemory) {
  const Heap before;
  // All of the longest accepted hello except its last byte, in one record.
  const std::string start = "\x16\x03\x01\x10\x04\x01\x00\x10\x00"s;
  sendFromAll(start + std::string(4095, 'x'));
  expectSmall("within the hello", before);
}

TEST_F(TlsMemoryTest, UnfinishedHandshakeUsesLittleMemory) {
  const Heap before;
  sendFromAll(RawTls().advance());
  expectSmall("after the hello", before);
}

TEST_F(TlsMemoryTest, ConnectionBeforeLoginUsesLittleMemory) {
  const Heap before;
  Recorder recorder;
  for (int i = 0; i < kConnections; ++i) {
    finishOne();
    accepted.back()->start(recorder.callbacks());
  }
  expectSmall("before login", before);
  for (std::size_t i = sockets.size() - kConnections; i < sockets.size(); ++i)
    asio::write(sockets[i], asio::buffer("\x17\x03\x03\x40\x00"s + std::string(16'000, 'x')));
  for (int i = 0; i < 4 * kConnections; ++i) runReady(context);
  EXPECT_FALSE(recorder.closed);
  expectSmall("before login, within a record", before);
  accepted.clear();
}

}  // namespace
}  // namespace naiad::test
