#include <gtest/gtest.h>

#include <asio/ip/address.hpp>

#include "shared/net/stream/ProxiedPeer.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad {
namespace {

using asio::ip::tcp;

const std::string kSignature("\r\n\r\n\0\r\nQUIT\n", 12);

tcp::endpoint at(const std::string& address, std::uint16_t port) {
  return {asio::ip::make_address(address), port};
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text.push_back(static_cast<char>(value));
  return text;
}

TEST(ProxyHeader, MatchesTheProxyProtocol) {
  // Section 2.2 of the PROXY protocol's specification: 192.0.2.7:50312, unknown destination.
  const std::string written =
      kSignature + bytes({0x21, 0x11, 0, 12, 192, 0, 2, 7, 0, 0, 0, 0, 0xc4, 0x88, 0, 0});
  EXPECT_EQ(proxyHeader(at("192.0.2.7", 50312)), written);
  EXPECT_EQ(readProxyHeader(written), at("192.0.2.7", 50312));
}

TEST(ProxyHeader, AddressesSurviveTheRoundTrip) {
  for (const auto& visitor :
       {at("192.0.2.7", 1), at("127.0.0.1", 65535), at("2001:db8::7", 50312), at("::1", 2)}) {
    const std::string header = proxyHeader(visitor);
    EXPECT_EQ(proxyHeaderRest(header.substr(0, kProxyHeaderBegin)), header.size() - kProxyHeaderBegin);
    EXPECT_EQ(readProxyHeader(header), visitor);
  }
  // An IPv4 address mapped into IPv6 counts as IPv4.
  EXPECT_EQ(readProxyHeader(proxyHeader(at("::ffff:192.0.2.7", 9))), at("192.0.2.7", 9));
  std::string header = proxyHeader(at("2001:db8::7", 9));
  const auto mapped = asio::ip::make_address_v6("::ffff:192.0.2.7").to_bytes();
  std::copy(mapped.begin(), mapped.end(), header.begin() + kProxyHeaderBegin);
  EXPECT_EQ(readProxyHeader(header), at("192.0.2.7", 9));
}

TEST(ProxyHeader, ExtraBytesAreSkippedUpToALimit) {
  std::string header = proxyHeader(at("192.0.2.7", 9));
  header[15] = static_cast<char>(kMaxProxyHeaderRest);
  header.resize(kProxyHeaderBegin + kMaxProxyHeaderRest, 'x');
  EXPECT_EQ(readProxyHeader(header), at("192.0.2.7", 9));
  header[15] = static_cast<char>(kMaxProxyHeaderRest + 1);
  header.push_back('x');
  EXPECT_FALSE(readProxyHeader(header));
  header[14] = static_cast<char>(0xff);
  EXPECT_FALSE(proxyHeaderRest(header.substr(0, kProxyHeaderBegin)));
}

TEST(ProxyHeader, OtherHeaderFormsAreRefused) {
  const std::string good = proxyHeader(at("192.0.2.7", 9));
  const auto with = [&good](std::size_t place, int value) {
    std::string changed = good;
    changed[place] = static_cast<char>(value);
    return changed;
  };
  ASSERT_TRUE(readProxyHeader(good));
  EXPECT_FALSE(readProxyHeader(with(0, 'P'))) << "version 1, or no header";
  EXPECT_FALSE(readProxyHeader(with(12, 0x20))) << "LOCAL";
  EXPECT_FALSE(readProxyHeader(with(12, 0x11))) << "another version";
  EXPECT_FALSE(readProxyHeader(with(13, 0x00))) << "no family";
  EXPECT_FALSE(readProxyHeader(with(13, 0x12))) << "UDP";
  EXPECT_FALSE(readProxyHeader(with(13, 0x31))) << "a socket of the file system";
  EXPECT_FALSE(readProxyHeader(with(13, 0x21))) << "longer addresses than there are";
  EXPECT_FALSE(readProxyHeader(with(15, 11))) << "too short";
  EXPECT_FALSE(readProxyHeader("PROXY TCP4 192.0.2.7 192.0.2.8 9 9\r\n"));
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(readProxyHeader(good.substr(0, size)));
  EXPECT_FALSE(readProxyHeader(good + "x"));
}

TEST(ProxyHeader, UnusableAddressesAreRefused) {
  for (const char* address : {"0.0.0.0", "255.255.255.255", "224.0.0.1", "::", "ff02::1"})
    EXPECT_FALSE(readProxyHeader(proxyHeader(at(address, 9)))) << address;
  EXPECT_FALSE(readProxyHeader(proxyHeader(at("192.0.2.7", 0))));
}

TEST(ProxyHeader, AddressTextIsParsedStrictly) {
  EXPECT_EQ(proxiedPeerFromText("192.0.2.7:50312"), at("192.0.2.7", 50312));
  EXPECT_EQ(proxiedPeerFromText("[2001:db8::7]:50312"), at("2001:db8::7", 50312));
  for (const char* text :
       {"", ":", "192.0.2.7", "192.0.2.7:", "192.0.2.7:0", "192.0.2.7:65536", "192.0.2.7:1x", "2001:db8::7",
        "[192.0.2.7]:9", "localhost:9", "0.0.0.0:9", "[::1:9", "::1]:9"})
    EXPECT_FALSE(proxiedPeerFromText(text)) << text;
}

TEST(ProxiedPeer, HaveTheSameAddressInEachForm) {
  for (const char* const text : {"192.0.2.7:50312", "[2001:db8::7]:50313"}) {
    const auto endpoint = *proxiedPeerFromText(text);
    const auto address = endpoint.address().is_v6()
                             ? endpoint.address().to_v6()
                             : asio::ip::make_address_v6(asio::ip::v4_mapped, endpoint.address().to_v4());
    const auto visitor = ProxiedPeer::of(address.to_bytes(), endpoint.port());
    EXPECT_EQ(visitor.name, text);
    EXPECT_EQ(visitor.prefix, AddressPrefix::of(endpoint.address()));
    EXPECT_EQ(readProxyHeader(visitor.header), endpoint);
  }
}

}  // namespace
}  // namespace naiad
