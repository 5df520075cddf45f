// The start line of requests. HttpResponseReaderTest.cpp tests lines and fields.
#include <gtest/gtest.h>

#include "shared/net/http/HttpHead.h"

namespace naiad::test {
namespace {

TEST(HttpRequestLine, HasMethodAndTarget) {
  const auto request = HttpRequestLine::parse("GET /metrics?a=b HTTP/1.1");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->method, "GET");
  EXPECT_EQ(request->target, "/metrics?a=b");
  EXPECT_TRUE(HttpRequestLine::parse("OPTIONS * HTTP/1.0"));
}

TEST(HttpRequestLine, RefusesMalformedLines) {
  for (const char* const line :
       {"", " ", "  ", "GET", "GET /", "GET / ", "GET  HTTP/1.1", "GET / HTTP/1.2", "GET / HTTP/2",
        "GET / http/1.1", "GET /a b HTTP/1.1", "GET  / HTTP/1.1", " GET / HTTP/1.1", "G\tT / HTTP/1.1",
        "GET /\t HTTP/1.1", "GET /\xc3\xa4 HTTP/1.1", "GET / HTTP/1.1 ", "/ HTTP/1.1"})
    EXPECT_FALSE(HttpRequestLine::parse(line)) << line;
}

}  // namespace
}  // namespace naiad::test
