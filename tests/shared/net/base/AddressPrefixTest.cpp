#include <gtest/gtest.h>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/stream/HalfOpenLimit.h"

namespace naiad {
namespace {

AddressPrefix of(const char* text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

TEST(AddressPrefix, IsTheWholeIPv4Address) {
  EXPECT_EQ(of("192.0.2.1"), of("192.0.2.1"));
  EXPECT_NE(of("192.0.2.1"), of("192.0.2.2"));
  EXPECT_EQ(of("::ffff:192.0.2.1"), of("192.0.2.1"));
  EXPECT_NE(of("0.0.0.0"), of("::"));
}

TEST(AddressPrefix, IsTheFirstHalfOfAnIPv6Address) {
  EXPECT_EQ(of("2001:db8:1:2::1"), of("2001:db8:1:2:ffff:ffff:ffff:ffff"));
  EXPECT_NE(of("2001:db8:1:2::1"), of("2001:db8:1:3::1"));
}

TEST(AddressPrefix, IsReadFromTheNameOfAPeer) {
  EXPECT_EQ(AddressPrefix::ofEndpoint("192.0.2.1:40000"), of("192.0.2.1"));
  EXPECT_EQ(AddressPrefix::ofEndpoint("[2001:db8:1:2::1]:9"), of("2001:db8:1:2::2"));
  for (const char* text : {"", "unknown", "virtual:server", ":", "[]:1"}) {
    EXPECT_FALSE(AddressPrefix::ofEndpoint(text)) << text;
  }
}

TEST(HalfOpenLimit, CountsInAllAndByPrefix) {
  using Answer = HalfOpenLimit::Answer;
  HalfOpenLimit limit(3, 2);
  EXPECT_EQ(limit.admit(of("10.0.0.1")), Answer::kAdmitted);
  EXPECT_EQ(limit.admit(of("10.0.0.1")), Answer::kAdmitted);
  EXPECT_EQ(limit.admit(of("10.0.0.1")), Answer::kFullForPrefix);
  EXPECT_EQ(limit.admit(of("10.0.0.2")), Answer::kAdmitted);
  EXPECT_EQ(limit.admit(of("10.0.0.3")), Answer::kFull);
  limit.release(of("10.0.0.1"));
  EXPECT_EQ(limit.count(), 2u);
  EXPECT_EQ(limit.admit(of("10.0.0.1")), Answer::kAdmitted);
  EXPECT_THROW(limit.release(of("10.0.0.3")), std::logic_error);
}

}  // namespace
}  // namespace naiad
