#include <gtest/gtest.h>

#include <set>
#include <string>

#include "shared/net/http/WebSocketUpgrade.h"

namespace naiad::test {
namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;

/// Returns the answer in RFC 6455, 1.3 with `changes` to its fields. An empty value removes a field.
HttpHead answer(const Fields& changes = {}) {
  HttpHead head{"",
                {{"upgrade", "WebSocket"},
                 {"connection", "keep-alive, upgrade"},
                 {"sec-websocket-accept", "s3pPLMBiTxaQ9kYGzzhZRbK+xOo="},
                 {"sec-websocket-protocol", "naiad.1"}}};
  for (const auto& [name, value] : changes) {
    std::erase_if(head.fields, [&removed = name](const auto& field) { return field.first == removed; });
    if (!value.empty()) head.fields.emplace_back(name, value);
  }
  return head;
}

const WebSocketUpgrade kUpgrade("naiad.1", "the sample nonce");

TEST(WebSocketUpgrade, RequestHasSubprotocolAndKey) {
  HttpRequest request{
      .target = "/play", .host = "example.org", .fields = {{"Origin", "https://example.org"}}};
  kUpgrade.addTo(request);
  EXPECT_EQ(
      request.text(),
      "GET /play HTTP/1.1\r\nHost: example.org\r\nOrigin: https://example.org\r\nConnection: Upgrade\r\n"
      "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
      "Sec-WebSocket-Protocol: naiad.1\r\n\r\n");
}

TEST(WebSocketUpgrade, RefusesAllOtherAnswers) {
  EXPECT_EQ(kUpgrade.problem(101, answer()), "") << "the standard's example";
  EXPECT_EQ(kUpgrade.problem(403, answer()), "status 403");
  EXPECT_EQ(kUpgrade.problem(200, answer()), "status 200");
  for (const Fields& changes :
       {Fields{{"upgrade", ""}}, Fields{{"upgrade", "h2c"}}, Fields{{"connection", "close"}},
        Fields{{"sec-websocket-accept", ""}},
        Fields{{"sec-websocket-accept", "S3pPLMBiTxaQ9kYGzzhZRbK+xOo="}},
        Fields{{"sec-websocket-protocol", ""}}, Fields{{"sec-websocket-protocol", "naiad.2"}},
        Fields{{"sec-websocket-extensions", "permessage-deflate"}}})
    EXPECT_NE(kUpgrade.problem(101, answer(changes)), "") << changes.front().first << changes.front().second;
  HttpHead twice = answer();
  twice.fields.emplace_back("sec-websocket-protocol", "naiad.1");
  EXPECT_NE(kUpgrade.problem(101, twice), "");
}

TEST(WebSocketUpgrade, KeysAndMasksDoNotRepeat) {
  std::set<std::string> keys;
  std::set<WebSocketFraming::Mask> masks;
  for (int i = 0; i < 100; ++i) {
    keys.insert(randomWebSocketKey());
    masks.insert(randomWebSocketMask());
  }
  EXPECT_EQ(keys.size(), 100U);
  EXPECT_GT(masks.size(), 98U);
}

}  // namespace
}  // namespace naiad::test
