#include <gtest/gtest.h>

#include <string>

#include "shared/net/stream/SocketBio.h"

namespace naiad {
namespace {

using namespace std::string_literals;

std::string record(char type, const std::string& payload) {
  return type + "\x03\x01"s + static_cast<char>(payload.size() >> 8) +
         static_cast<char>(payload.size() & 0xff) + payload;
}

std::string hello(std::size_t size) {
  return "\x01"s + static_cast<char>(size >> 16) + static_cast<char>(size >> 8 & 0xff) +
         static_cast<char>(size & 0xff) + std::string(size, 'x');
}

bool acceptsInPieces(const std::string& bytes, std::size_t piece) {
  ClientHelloGuard guard;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    if (!guard.accept(std::string_view(bytes).substr(at, piece))) return false;
  }
  return true;
}

TEST(ClientHelloGuard, PassesHellosUpToTheLimitInAnyPieces) {
  const std::string largest = hello(ClientHelloGuard::kMaxHello);
  const std::string whole = record(22, largest);
  const std::string cut = record(22, largest.substr(0, 2)) + record(22, "") +
                          record(22, largest.substr(2, 1000)) + record(22, largest.substr(1002));
  for (const std::size_t piece : {1u, 3u, 5u, 7u, 100000u}) {
    EXPECT_TRUE(acceptsInPieces(whole, piece));
    EXPECT_TRUE(acceptsInPieces(cut, piece));
    EXPECT_TRUE(acceptsInPieces(whole + whole, piece));  // a second hello follows a HelloRetryRequest
  }
}

TEST(ClientHelloGuard, StopsAnOversizedHelloAtItsHeader) {
  const std::string longer = hello(ClientHelloGuard::kMaxHello + 1).substr(0, 4);
  const std::string small = record(22, hello(10));
  for (const std::size_t piece : {1u, 3u, 5u, 7u, 100000u}) {
    EXPECT_FALSE(acceptsInPieces(record(22, longer), piece));
    EXPECT_FALSE(acceptsInPieces(record(22, longer.substr(0, 1)) + record(22, longer.substr(1)), piece));
    EXPECT_FALSE(acceptsInPieces(small + record(22, longer), piece));
    EXPECT_FALSE(acceptsInPieces(small + record(20, "\x01") + record(22, longer), piece));
    EXPECT_FALSE(acceptsInPieces(record(22, hello(10) + longer), piece));
  }
}

TEST(ClientHelloGuard, LeavesEncryptedRecordsAlone) {
  EXPECT_TRUE(acceptsInPieces(
      record(22, hello(10)) + record(23, std::string(5000, '\xff')) + record(23, "\x01\xff\xff\xff"), 1));
}

}  // namespace
}  // namespace naiad
