// Answers of web servers: the result does not depend on how they are split. Ambiguous answers are rejected.
// The start line of requests.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "shared/net/http/HttpResponseReader.h"

namespace naiad::test {
namespace {

struct Answer {
  bool done = false;
  HttpError error = HttpError::kNone;
  unsigned status = 0;
  std::string body;
  std::string behind;

  friend bool operator==(const Answer&, const Answer&) = default;
};

std::ostream& operator<<(std::ostream& out, const Answer& answer) {
  return out << "done " << answer.done << " error " << static_cast<int>(answer.error) << " status "
             << answer.status << " body \"" << answer.body << "\" behind \"" << answer.behind << '"';
}

/// Reads these pieces, and then the end of the connection if `ends`.
Answer readPieces(const std::vector<std::string_view>& pieces, bool ends, const HttpLimits& limits) {
  HttpResponseReader reader(limits);
  Answer answer;
  for (std::string_view piece : pieces) {
    reader.feed(piece);
    if (reader.isDone()) answer.behind += piece;
  }
  if (ends) reader.feedEnd(true);
  answer.done = reader.isDone();
  answer.error = reader.error();
  if (reader.hasHead()) answer.status = reader.status();
  answer.body = reader.body();
  return answer;
}

/// Reads the text at once, byte by byte, and split at each position. All results must be equal.
Answer readText(const std::string& text, bool ends = false, const HttpLimits& limits = {}) {
  const std::string_view view = text;
  const Answer whole = readPieces({view}, ends, limits);
  std::vector<std::string_view> bytes;
  for (std::size_t i = 0; i < view.size(); ++i) bytes.push_back(view.substr(i, 1));
  EXPECT_EQ(readPieces(bytes, ends, limits), whole) << text;
  for (std::size_t i = 0; i <= view.size() && view.size() < 2000; ++i)
    EXPECT_EQ(readPieces({view.substr(0, i), view.substr(i)}, ends, limits), whole) << text << " at " << i;
  return whole;
}

HttpError errorOf(const std::string& text) {
  const Answer answer = readText(text, true);
  EXPECT_NE(answer.done, answer.error != HttpError::kNone);
  return answer.error;
}

const std::string kOk = "HTTP/1.1 200 OK\r\n";

TEST(HttpResponseReader, ReadsABodyWithContentLength) {
  const Answer answer = readText(kOk + "Content-Length: 5\r\nX: y\r\n\r\nhello and more");
  EXPECT_EQ(answer, (Answer{true, HttpError::kNone, 200, "hello", " and more"}));
  EXPECT_TRUE(readText(kOk + "content-length:\t0 \r\n\r\n").done);
}

TEST(HttpResponseReader, ReadsChunksWithExtensionsAndTrailers) {
  const Answer answer =
      readText(kOk + "Transfer-Encoding: Chunked\r\n\r\n5\r\nhello\r\n00A ;a=b\r\n, chunked!\r\n" +
               "0\r\nDigest: x\r\n\r\nnext");
  EXPECT_EQ(answer, (Answer{true, HttpError::kNone, 200, "hello, chunked!", "next"}));
}

TEST(HttpResponseReader, ReadsToTheEndOfTheConnection) {
  EXPECT_EQ(readText("HTTP/1.0 404 \r\n\r\nno", true), (Answer{true, HttpError::kNone, 404, "no", ""}));
  EXPECT_FALSE(readText(kOk + "\r\nno").done);
}

TEST(HttpResponseReader, SkipsInterimAnswers) {
  const Answer answer =
      readText("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 103 Early Hints\r\nLink: <a>\r\n\r\n" + kOk +
               "Content-Length: 1\r\n\r\n.");
  EXPECT_EQ(answer, (Answer{true, HttpError::kNone, 200, ".", ""}));
}

TEST(HttpResponseReader, AnswersWithoutABodyEndWithTheirHead) {
  for (const char* const status : {"101", "204", "304"}) {
    const Answer answer =
        readText("HTTP/1.1 " + std::string(status) + " X\r\nContent-Length: 7\r\n\r\n\x81\x01x");
    EXPECT_EQ(answer.behind, "\x81\x01x");
    EXPECT_TRUE(answer.done && answer.body.empty()) << status;
  }
}

TEST(HttpResponseReader, FindsFieldsInAnyCase) {
  std::string_view text =
      "HTTP/1.1 200\r\nLOCATION: \t/a b\t \r\nConnection: close , Upgrade\r\nEmpty:\r\n\r\n";
  HttpResponseReader reader;
  reader.feed(text);
  EXPECT_EQ(reader.head().value("location"), "/a b");
  EXPECT_EQ(reader.head().value("missing"), "");
  EXPECT_TRUE(reader.head().lists("connection", "upgrade"));
  EXPECT_FALSE(reader.head().lists("connection", "keep-alive"));
  EXPECT_EQ(reader.head().count("empty"), 1U);
}

TEST(HttpResponseReader, RefusesStartLinesOfOtherProtocols) {
  for (const char* const line : {"", "HTTP/1.1", "HTTP/1.2 200 OK", "HTTP/2 200", "http/1.1 200 OK",
                                 "HTTP/1.1  200 OK", "HTTP/1.1 20 OK", "HTTP/1.1 2000 OK", "HTTP/1.1 200OK",
                                 "HTTP/1.1 +20 OK", "HTTP/1.1 099 OK", "ICY 200 OK", "\x16\x03\x01"})
    EXPECT_EQ(errorOf(std::string(line) + "\r\nContent-Length: 0\r\n\r\n"), HttpError::kMalformed) << line;
}

TEST(HttpResponseReader, RefusesAmbiguousHeaderLines) {
  for (const char* const lines :
       {"A: b\r\n c\r\n", "A: b\r\n\tc\r\n", "A : b\r\n", " A: b\r\n", ": b\r\n", "A\r\n", "A b: c\r\n",
        "A: b\rc\r\n", "A: b\n", "A: b\n\r\n", "A: \x01\r\n", "A: \x7f\r\n", "\xc3\xa4: b\r\n"})
    EXPECT_EQ(errorOf(kOk + lines + "Content-Length: 0\r\n\r\n"), HttpError::kMalformed) << lines;
  EXPECT_EQ(errorOf(kOk + "A: " + std::string(1, '\0') + "\r\n\r\n"), HttpError::kMalformed);
  EXPECT_TRUE(readText(kOk + "A: \xc3\xa4\tb\r\nContent-Length: 0\r\n\r\n").done);
}

TEST(HttpResponseReader, RefusesAmbiguousFraming) {
  for (const char* const lines :
       {"Content-Length: 1\r\nContent-Length: 1\r\n", "Content-Length: 1\r\nContent-Length: 2\r\n",
        "Content-Length: 1, 1\r\n", "Content-Length: +1\r\n", "Content-Length: -1\r\n",
        "Content-Length: 0x1\r\n", "Content-Length:\r\n", "Content-Length: 18446744073709551616\r\n",
        "Content-Length: 1\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: gzip, chunked\r\n", "Transfer-Encoding: identity\r\n", "Transfer-Encoding:\r\n"})
    EXPECT_EQ(errorOf(kOk + lines + "\r\n1\r\na\r\n0\r\n\r\n"), HttpError::kMalformed) << lines;
  EXPECT_EQ(errorOf("HTTP/1.0 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"), HttpError::kMalformed);
}

TEST(HttpResponseReader, RefusesMalformedChunks) {
  for (const char* const chunks :
       {"\r\n", "x\r\n", " 1\r\na\r\n", "0x1\r\na\r\n", "+1\r\na\r\n", "1\na\r\n", "1\r\nab\r\n", "1\r\na\n",
        "1;\r\r\n", "0\r\nno field\r\n\r\n", "11111111111111111\r\n"})
    EXPECT_EQ(errorOf(kOk + "Transfer-Encoding: chunked\r\n\r\n" + chunks), HttpError::kMalformed) << chunks;
}

TEST(HttpResponseReader, EveryTruncationIsDetected) {
  for (const std::string& text : {kOk + "Content-Length: 3\r\n\r\nabc",
                                  kOk + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\nA: b\r\n\r\n"}) {
    EXPECT_TRUE(readText(text, true).done);
    for (std::size_t i = 0; i < text.size(); ++i)
      EXPECT_EQ(errorOf(text.substr(0, i)), HttpError::kTruncated) << text.substr(0, i);
  }
}

TEST(HttpResponseReader, HeadSizeIsLimitedInTotal) {
  const HttpLimits limits{.head = 200, .body = 10};
  const auto with = [&](std::size_t head) {
    const std::string begin = kOk + "A: ";
    const std::string end = "\r\nContent-Length: 0\r\n\r\n";
    return readText(begin + std::string(head - begin.size() - end.size(), 'x') + end, true, limits);
  };
  EXPECT_TRUE(with(200).done);
  EXPECT_EQ(with(201).error, HttpError::kHeadTooLong);
  EXPECT_EQ(readText(std::string(201, 'x'), false, limits).error, HttpError::kHeadTooLong);
  std::string interim;
  for (int i = 0; i < 9; ++i) interim += "HTTP/1.1 100 \r\nA: b\r\n\r\n";
  EXPECT_EQ(readText(interim, false, limits).error, HttpError::kHeadTooLong);
}

TEST(HttpResponseReader, BodySizeIsLimitedInEveryFraming) {
  const HttpLimits limits{.head = 200, .body = 10};
  const std::string chunked = kOk + "Transfer-Encoding: chunked\r\n\r\n";
  EXPECT_EQ(readText(kOk + "\r\n0123456789", true, limits).body, "0123456789");
  EXPECT_EQ(readText(kOk + "\r\n0123456789a", true, limits).error, HttpError::kBodyTooLong);
  EXPECT_TRUE(readText(kOk + "Content-Length: 10\r\n\r\n0123456789", true, limits).done);
  EXPECT_EQ(readText(kOk + "Content-Length: 11\r\n\r\n", false, limits).error, HttpError::kBodyTooLong);
  EXPECT_TRUE(readText(chunked + "5\r\n01234\r\n5\r\n56789\r\n0\r\n\r\n", true, limits).done);
  EXPECT_EQ(readText(chunked + "5\r\n01234\r\n6\r\n", false, limits).error, HttpError::kBodyTooLong);
  EXPECT_EQ(readText(chunked + "ffffffffffffffff\r\n", false, limits).error, HttpError::kBodyTooLong);
  EXPECT_EQ(readText(chunked + "1;" + std::string(300, 'x'), false, limits).error, HttpError::kHeadTooLong);
  EXPECT_EQ(readText(chunked + "0\r\n" + std::string(300, 'x'), false, limits).error,
            HttpError::kHeadTooLong);
}

TEST(HttpResponseReader, EndlessAnswerIsReadInPieces) {
  HttpResponseReader reader({.head = 200, .body = HttpLimits::kUnlimited});
  const std::string head = kOk + "Transfer-Encoding: chunked\r\n\r\n";
  std::string_view bytes = head;
  reader.feed(bytes);
  for (int i = 0; i < 1000; ++i) {  // each chunk has its own limit
    bytes = "8\r\nabcdefg\n\r\n";
    reader.feed(bytes);
    ASSERT_EQ(reader.error(), HttpError::kNone) << i;
    ASSERT_EQ(reader.popBody(), "abcdefg\n") << i;
  }
  EXPECT_TRUE(reader.body().empty());
}

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
