// The visitors' socket of a real server: a client that connects through it counts with its visitor's address.
#include <gtest/gtest.h>

#include <asio/write.hpp>

#include "VisitedServer.h"

namespace naiad::test {
namespace {

class VisitorsTest : public VisitedServer {
 protected:
  VisitorsTest() { options.max_per_address = 2; }
};

TEST_F(VisitorsTest, PlayersCountForTheirOwnAddress) {
  TestServer server(busyWorld(5), options);
  TestClient ann(context, server.port(), from("192.0.2.7:50312", "ann"));
  TestClient bob(context, server.port(), from("192.0.2.7:50313", "bob"));
  ASSERT_TRUE(joins(ann));
  ASSERT_TRUE(joins(bob));
  TestClient third(context, server.port(), from("192.0.2.7:50314", "cat"));
  EXPECT_NE(refusal(third), "");
  TestClient dan(context, server.port(), from("[2001:db8::7]:50315", "dan"));
  TestClient eve(context, server.port(), home.player("eve"));
  EXPECT_TRUE(joins(dan));
  EXPECT_TRUE(joins(eve)) << "this machine itself has nobody in the game";
  EXPECT_EQ(server.counters().joined, 4u);
}

TEST_F(VisitorsTest, NoHeaderIsReadFromTcp) {
  TestServer server(busyWorld(5), options);
  asio::ip::tcp::socket socket(context);
  socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  asio::write(socket, asio::buffer(proxyHeader({asio::ip::make_address("192.0.2.9"), 9})));
  // The server reads the header as a broken TLS hello, so it sends at most a TLS alert and closes the
  // connection.
  socket.non_blocking(true);
  std::string heard;
  TestClient ann(context, server.port(), home.player("ann"));
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] {
    char bytes[256];
    std::error_code error;
    const std::size_t size = socket.read_some(asio::buffer(bytes), error);
    heard.append(bytes, size);
    return error && error != asio::error::would_block;
  }));
  EXPECT_LE(heard.size(), 7u) << "a TLS record with an alert";
  EXPECT_TRUE(joins(ann));
  EXPECT_EQ(server.counters().connections, 1u);
}

TEST_F(VisitorsTest, MissingVisitorSocketGivesAMessage) {
  TestServer server(busyWorld(5), home.server());
  TestClient ann(context, server.port(), from("192.0.2.7:50312", "ann"));
  EXPECT_TRUE(has(refusal(ann), "Could not connect through")) << ann.connection().message();
}

}  // namespace
}  // namespace naiad::test
