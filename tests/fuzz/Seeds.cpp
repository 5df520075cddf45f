// Writes the inputs that fuzzing began with: honest ones, by the product's own writers, a folder for each
// target.
//
// usage: fuzz_seeds DIRECTORY
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "ScriptedLink.h"
#include "SeedFolder.h"
#include "WorldSeeds.h"
#include "naiad.pb.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/Limits.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/stream/Framing.h"
#include "shared/net/stream/VisitorHeader.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/ServerMessageSamples.h"

namespace naiad::fuzz {
namespace {

void frames(Folder folder) {
  std::string stream;
  for (const std::size_t size : {1u, 5u, 300u}) appendFrame(stream, std::string(size, 'x'));
  for (const char how : {0, 1, 9}) folder.add(u16(64) + u16(512) + how + stream);
  folder.add(u16(4) + u16(4) + '\x03' + stream);
  folder.add(u16(64) + u16(64) + '\x03' + std::string(2, '\0'));
}

void texts(Folder folder) {
  folder.add(
      "\x10"
      "Ann");
  folder.add("\x28 na\xC3\xAFve\t\xE2\x96\x93 \xF0\x9F\x98\x80 \x1B[2J\r\n\xE2\x80\x8B");
  folder.add("\x04\xC0\x80\xED\xA0\x80\xF4\x90\x80\x80\xE2\x82");
}

const std::string kLink = "naiad://game.example:9877/room-1#abcdefghijklmnopqrstuvwxya";

void links(Folder folder) {
  for (const char* const text :
       {"naiad://[2001:db8::7]#ABCDEFGHIJKLMNOPQRSTUVWXYA", "NAIAD://%5b::1%5d:1%23",
        "naiad://user@game.example/?x#a", "http://play.example:8080/#abcdefghijklmnopqrstuvwxya",
        "https://[::1]", "https://play.example/other", "abcdefghijklmnopqrstuvwxya"})
    folder.add(text);
  folder.add(kLink);
}

void visitors(Folder folder) {
  const auto at = [](const char* address) {
    return asio::ip::tcp::endpoint(asio::ip::make_address(address), 50312);
  };
  folder.add(visitorHeader(at("192.0.2.7")));
  folder.add(visitorHeader(at("2001:db8::7")));
  folder.add("192.0.2.7:40000");
  folder.add("[2001:db8::7]:40000");
}

void gamesLists(Folder folder) {
  folder.add("# games\n\nhello " + kLink + " /run/hello\n  tron\t" + kLink + " /run/tron password\n");
  folder.add("hello " + kLink + " /run/hello pass\n");
  folder.add("hello " + kLink + "\n");
  folder.add("hello naiad:// /run/hello\n");
}

void busPayloads(Folder folder) {
  Presence presence;
  presence.id = "berlin-9876";
  presence.name = "Berlin";
  presence.game = "tron";
  presence.host = "192.0.2.7";
  presence.port = kDefaultPort;
  presence.key = std::string(64, 'a');
  presence.protocol = kProtocolVersion;
  folder.add(std::string(1, '\0') + presence.payload());
  presence.rooms = {{"lobby", "lobby", 3, 64}, {"duel", "tron", 2, 2}};
  folder.add(std::string(1, '\0') + presence.payload());
  presence.host = "-o";
  folder.add(std::string(1, '\0') + presence.payload());
  presence.host = "2001:db8::7";
  folder.add(std::string(1, '\0') + presence.payload());
  GameResult result;
  result.server = "berlin-9876";
  result.game = "tron";
  result.table = "rides";
  result.name = "Ann";
  result.points = 143;
  result.round = std::string(32, '0');
  folder.add("\1" + result.payload());
  const std::string server =
      R"({"object_meta":{"name":"naiad-x7"},"spec":{"health":{"period_seconds":5}},"status":{"state":"Ready",)"
      R"("address":"192.0.2.7","ports":[{"name":"default","port":7012}]}})";
  folder.add("\2" + server);
  folder.add("\3{\"result\":" + server + "}");
  presence.max_players = 16;
  std::string heard = "\4";
  for (const std::string id : {"berlin-9876", "paris-9876"}) {
    presence.id = id;
    heard += "naiad.presence." + id + " " + presence.payload() + "\n";
  }
  folder.add(heard);
}

void webRequests(Folder folder) {
  const std::string host = "Host: play.example\r\n";
  const std::string upgrade =
      "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
      "AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: naiad.1\r\nOrigin: https://play.example\r\n\r\n";
  const auto add = [&folder](const std::string& request) { folder.add("\2" + request); };
  folder.add(std::string(1, '\0') + "https://[::1]:8443/");
  folder.add(std::string(1, '\0') + "http://play.example");
  folder.add("\1a \"name\\\x1b");
  add("GET /play HTTP/1.1\r\n" + host + upgrade);
  add("GET /other HTTP/1.1\r\n" + host + upgrade);
  add("GET / HTTP/1.1\r\n" + host + "Accept-Encoding: br, gzip;q=0.5\r\n\r\n");
  add("GET /font.woff2?x HTTP/1.1\r\n" + host + "If-None-Match: *\r\nConnection: close\r\n\r\n");
  add("HEAD /index.html HTTP/1.1\r\n" + host + "Accept-Encoding: gzip;q=0\r\n\r\n");
  for (const char* const line : {"GET /server", "GET /play", "GET /nothing", "POST /"})
    add(std::string(line) + " HTTP/1.1\r\n" + host + "\r\n");
  add("GET / HTTP/1.0\r\n" + host + "\r\n");
  add("GET / HTTP/1.1\r\nHost: other.example\r\n\r\n");
}

void httpResponses(Folder folder) {
  const std::string ok = "HTTP/1.1 200 OK\r\n";
  for (const std::string& stream :
       {ok + "Content-Length: 5\r\n\r\nhello",
        ok + "Transfer-Encoding: chunked\r\n\r\n5;a=b\r\nhello\r\nA \r\n, chunked!\r\n0\r\nDigest: x\r\n\r\n",
        "HTTP/1.1 100 Continue\r\n\r\n" + ok + "content-length: 0\r\nX:\r\nX: a, b\r\n\r\n",
        std::string("HTTP/1.0 404 \r\n\r\nuntil the end"),
        std::string("HTTP/1.1 101\r\nUpgrade: websocket\r\n\r\n\x82\x01x"),
        ok + "Content-Length: 1\r\nContent-Length: 1\r\n\r\nx", ok + "A: b\r\n c\r\n\r\n",
        ok + "A : b\r\n\r\n", std::string("HTTP/1.1 304 \r\nContent-Length: 7\r\n\r\n"),
        std::string("HTTP/2 200\r\n\r\n"), ok + "Transfer-Encoding: chunked\r\n\r\n1\r\nxx\r\n",
        ok + "Transfer-Encoding: gzip\r\n\r\n",
        ok + "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n5\r\nworld\r\n0\r\n\r\n"}) {
    for (const char how : {'\0', '\1', '\5'})
      folder.add(u16(512) + u16(64) + std::string{how, '\1'} + stream);
    folder.add(u16(512) + u16(8) + std::string(2, '\0') + stream);
    folder.add(u16(30) + u16(64) + std::string(2, '\0') + stream);
  }
}

void webSocketFrames(Folder folder) {
  for (const std::string& stream :
       {std::string("\x82\x05hello\x82\x00\x89\x02hi\x8a\x00\x82\x01x", 17),
        std::string("\x02\x01"
                    "a\x89\x01p\x00\x00\x80\x01"
                    "b",
                    11),
        std::string("\x82\x7e\x00\x80", 4) + std::string(128, 'm'),
        std::string("\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10), std::string("\x88\x06\x0f\xa0gone"),
        std::string("\x88\x00", 2), std::string("\x88\x02\x03\xe8"), std::string("\x88\x02\x03\xed"),
        std::string("\x88\x01x"), std::string("\x81\x01t"), std::string("\xc2\x01x"),
        std::string("\x82\x81\1\2\3\4x"), std::string("\x80\x01x"), std::string("\x02\x01x\x82\x01y"),
        std::string("\x09\x01x"), std::string("\x83\x01x"), std::string("\x8b\x01x"),
        std::string("\x82\x7e\x00\x05hello", 9)}) {
    for (const char how : {'\0', '\1', '\5'}) folder.add(u16(200) + how + stream);
    folder.add(u16(1) + std::string(1, '\0') + stream);
  }
}

void keys(Folder folder) {
  for (const std::string& text :
       {"aZ1 \r\t\x7F\x03", "\x1B[A\x1B[1;5B\x1BOP\x1B[3~\x1B[15;2~", "\x1B[97;5u\x1B[57399;1:3u\x1B[?3u",
        "\x1B[<0;10;5M\x1B[<0;10;5m\x1B[<35;1;1M", "\x1B[M !!\x1B[[A\x1B[5^\x1B[7$\x1B[c\x1BOd",
        "\x1B[200~pasted\x1B[201~", "\x1B]0;title\x07\x1BPq\x1B\\\x1B\x1B[A\x1Bx",
        "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80", "\x1B[27;5;97~\x1B[1089::99;5u\x1B[97:65;2:2;65u"}) {
    folder.add(static_cast<char>(text.size()) + text);
    folder.add(std::string(1, static_cast<char>(3)) + text.substr(0, 3) + static_cast<char>(0x80 + 60) +
               text.substr(3));
  }
}

void updates(Folder folder) {
  const std::string context("\x40\0\0\0\x80\0\0\0\x05\0\0\0\0", 13);
  ClientUpdate update;
  folder.add(context + writeUpdate(update));
  update.acks = {0x40, ~std::uint64_t{0}};
  update.checksum = 0x0123456789ABCDEF;
  update.inputs.push_back({6, 0x7E, 0x3F, false, 1, 33, 0, 0, 0});
  update.inputs.push_back({7, 0x80, 0x40, true, 2, 0, 2, 79, 23});
  folder.add(context + writeUpdate(update));
  update.acks.mask = 5;
  update.wants_reset = true;
  for (std::uint32_t id = 8; id < 30; ++id)
    update.inputs.push_back({id, 0x80 + id, 0x10, false, 0, 1, 0, 0, 0});
  folder.add(context + writeUpdate(update));
}

/// Random numbers, small ones mostly.
std::string smallNumbers(SplitMix64& random, std::size_t count) {
  std::string bytes = randomBytes(random, count);
  for (char& byte : bytes) {
    if (random.below(8) != 0) byte = static_cast<char>(byte & 7);
  }
  return bytes;
}

void hostile(Folder updates, Folder snapshots) {
  SplitMix64 random(13);
  for (std::size_t i = 0; i < 16; ++i) {
    updates.add(std::string("\x40\0\0\0\x80\0\0\0\x05\0\0\0\1", 13) + smallNumbers(random, 20 + 8 * i));
    snapshots.add(smallNumbers(random, 20 + 8 * i));
  }
}

void controls(Folder folder) {
  df::ControlTable table;
  table.bounded = table.whole_cells = true;
  table.bounds = {{}, {df::fromCells(80), df::fromCells(24)}};
  table.patience = 30;
  table.rows.push_back(
      {df::Keyboard::W, df::KEY_PRESSED, df::ControlEffect::kStep, true, true, {0, -df::kFixedOne}, 2, 1});
  table.rows.push_back(
      {df::Keyboard::D, df::KEY_PRESSED, df::ControlEffect::kDrive, true, false, {df::kFixedOne, 0}, 0, 0});
  std::string bytes(5, '\0');
  writeControlTable(bytes, table);
  folder.add(bytes);
  ControlRecord record;
  record.slot = 4;
  record.generation = 1;
  record.newest_input = 9;
  record.position = {df::fromCells(3), df::fromCells(4)};
  record.velocity = {df::kFixedOne / 2, 0};
  record.state.steering = true;
  record.state.wait[1] = 3;
  bytes.assign("\1\0\0\0\0", 5);
  writeControlRecord(bytes, record);
  folder.add(bytes);
}

void serverMessages(Folder folder) {
  for (wire::ServerMessage& message : test::serverMessages("Ann", 2)) {
    folder.add(message.SerializeAsString());
    message.set_number(4);
    folder.add(message.SerializeAsString());
  }
}

constexpr std::size_t kDatagram = 0x2000, kTick = 0x4000, kHello = 0x8000;  // see targets/client_message.cpp

std::string framed(const wire::ClientMessage& message, std::size_t flags) {
  const std::string bytes = message.SerializeAsString();
  return u16(bytes.size() | flags) + bytes;
}

std::string framed(const ClientUpdate& update, std::size_t flags) {
  const std::string bytes = writeUpdate(update);
  if ((flags & kDatagram) != 0) return u16(bytes.size() | flags) + bytes;
  wire::ClientMessage message;
  message.set_update(bytes);
  return framed(message, flags);
}

ClientUpdate withKeys(std::uint32_t first, std::uint32_t count, std::uint32_t tick, std::uint8_t key) {
  ClientUpdate update;
  for (std::uint32_t id = first; id < first + count; ++id)
    update.inputs.push_back({id, tick, 0, false, 1, key, 0, 0, 0});
  return update;
}

/// What the rules count and limit: each of these goes once beyond a limit.
void beyondLimits(Folder folder) {
  wire::ClientMessage chat;
  chat.mutable_chat()->set_text("hi");
  chat.set_number(1);
  std::string chats = framed(chat, kHello) + framed(chat, 0);  // the second has come before
  chat.clear_number();
  for (int i = 0; i < 4; ++i) chats += framed(chat, 0);
  chat.mutable_chat()->set_text(" ");
  folder.add(chats + framed(chat, kTick));

  ClientUpdate sums, resets;
  sums.acks = {1, 0};
  sums.checksum = 7;
  folder.add(framed(ClientUpdate(), kHello | kTick) + framed(sums, kTick) + framed(sums, kTick) +
             framed(sums, kDatagram | kTick) + std::string("\0\0\4", 3) + framed(sums, kTick));
  resets.wants_reset = true;
  folder.add(framed(resets, kHello) + framed(resets, 0) + std::string("\0\0\7", 3) + framed(resets, kTick));

  folder.add(framed(withKeys(1, 40, 1, 3), kHello) + framed(withKeys(41, 40, 1, 3), 0));  // 64 may wait
  folder.add(framed(withKeys(1, 3, 1, 3), kHello) + framed(withKeys(2, 3, 1, 3), kDatagram) +
             framed(withKeys(2, 4, 1, 3), kDatagram | kTick));
  // A key that waits for its tick, one that asks for nonsense, one without a tick, and a click.
  for (const std::uint32_t tick : {4u, 400u, 0u})
    folder.add(framed(withKeys(1, 1, tick, 5), kHello | kTick) + framed(ClientUpdate(), kTick) +
               framed(withKeys(2, 1, tick + 2, 3), kTick) + framed(ClientUpdate(), kTick));
  ClientUpdate click;
  click.inputs.push_back({1, 4, 0, true, 1, 0, 1, 12, 5});
  folder.add(framed(click, kHello | kTick) + framed(ClientUpdate(), kTick));

  wire::ClientMessage size;
  size.mutable_resize()->set_columns(40);
  folder.add(framed(size, kHello) + framed(size, 0) + framed(size, kTick));
  size.mutable_ping()->set_rtt_millis(30);
  const std::string many("\0\0\2", 3);  // the last frame, a hundred times
  folder.add(framed(size, kHello) + many + many + many + many + many + many + many + many + many + many +
             many);
  folder.add(framed(size, kHello) + u16(3 | kDatagram) + "bad");
  folder.add(framed(size, kHello) + std::string("\0\0\3", 3) + framed(withKeys(1, 1, 1, 3), kDatagram));
}

/// Two streams: what comes on both, what only one may say, and what either does while the other is busy.
void onTwoStreams(Folder folder) {
  const auto meddle = [](int what) { return std::string{'\0', '\0', static_cast<char>(what)}; };
  const std::string two = framed(withKeys(1, 1, 1, 3), kHello | kTick) + meddle(252);
  const std::string key = framed(withKeys(2, 1, 1, 3), kTick);
  wire::ClientMessage chat;
  chat.mutable_chat()->set_text("hi");
  folder.add(two + key + meddle(253) + key + framed(withKeys(3, 1, 1, 3), kTick));
  folder.add(two + meddle(253) + framed(chat, kTick));
  folder.add(two + meddle(253) + u16(3) + "bad");
  folder.add(two + meddle(255) + key + meddle(1) + key + meddle(255) + key);
  folder.add(two + meddle(254) + key + meddle(253) + key);
  folder.add(two + meddle(0) + meddle(253) + key);
  folder.add(two + meddle(3) + meddle(253) + key);
}

void clientMessages(Folder folder) {
  std::string all;
  const auto add = [&](const wire::ClientMessage& message, std::size_t flags) {
    const std::string bytes = message.SerializeAsString();
    folder.add(u16(bytes.size() | flags) + bytes);
    all += u16(bytes.size() | (all.empty() ? flags : 0x4000)) + bytes;
  };
  wire::ClientMessage message;
  ClientUpdate update;
  update.acks = {1, 0};
  update.inputs.push_back({1, 1, 1, false, 0, 33, 0, 0, 0});
  message.set_update(writeUpdate(update));
  add(message, 0xC000);
  message.mutable_chat()->set_text("hello");
  add(message, 0xC000);
  message.mutable_ping()->set_token(7);
  message.mutable_ping()->set_rtt_millis(30);
  add(message, 0xC000);
  message.mutable_resize()->set_columns(80);
  add(message, 0xC000);
  message.mutable_list_rooms();
  add(message, 0xC000);
  message.mutable_enter()->set_room("arcade");
  message.set_number(1);
  add(message, 0xC000);
  message.clear_number();
  message.mutable_leave();
  add(message, 0xC000);
  folder.add(all);
  wire::Hello& hello = *message.mutable_hello();
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name("Ann");
  add(message, 0);
  hello.set_room("arcade");
  hello.set_rooms(true);
  wire::ClientMessage enter;
  enter.mutable_enter()->set_room("arcade");
  folder.add(framed(message, 0) + framed(enter, kTick) + framed(enter, kTick) + framed(enter, kTick) +
             framed(enter, kTick) + framed(enter, kTick) + framed(ClientUpdate(), kTick));
  hello.set_protocol(1);
  add(message, 0x4000);
}

/// Random scripts; and what the client and the server heard in the short ones.
void replication(Folder folder, Folder snapshots) {
  SplitMix64 random(11);
  for (std::size_t i = 0; i < 24; ++i) {
    const std::string script = randomBytes(random, i < 12 ? 40 + 10 * i : 200 + 20 * i);
    folder.add(script);
    std::string heard(1, '\0');
    Script reader(reinterpret_cast<const std::uint8_t*>(script.data()), script.size());
    ScriptedLink link(static_cast<Resend>(reader.below(3)));
    link.on_snapshot = [&heard](const std::string& bytes) {
      if (heard.size() + bytes.size() < 1500) heard += u16(bytes.size()) + bytes;
    };
    link.run(reader, 30);
    snapshots.add(heard);
  }
}

/// Messages with most kinds of fields, and what a codec could take for good.
void wireMessages(Folder folder) {
  constexpr char kHello = 0, kClient = 2, kList = 8, kServer = 14;  // by their order in naiad.proto
  wire::ClientMessage client;
  wire::Hello& hello = *client.mutable_hello();
  hello.set_magic(kHelloMagic);
  hello.set_player_name("na\xC3\xAFve");
  hello.add_aeads(1);
  hello.add_aeads(300);
  hello.set_fresh(true);
  client.set_number(70000);
  folder.add(kHello + hello.SerializeAsString());
  folder.add(kClient + client.SerializeAsString());
  for (const wire::ServerMessage& server : test::serverMessages("Ann", 2)) {
    folder.add(kServer + server.SerializeAsString());
    if (server.has_players()) folder.add(kList + server.players().SerializeAsString());
    if (server.has_sounds()) folder.add(kServer + server.SerializeAsString() + server.SerializeAsString());
  }
  folder.add(kHello + std::string("\x48\x01\x4A\x02\x80\x01\x08\x01\xFB\x01\x58\x01\xFC\x01\xFF"));
  folder.add(kHello + std::string("\x1A\x03\xED\xA0\x80\xCA\x80\x80\x80\x00\x01\x05", 12));
}

void datagrams(Folder folder) {
  SplitMix64 random(12);
  for (std::size_t i = 0; i < 16; ++i) folder.add(randomBytes(random, 40 + 20 * i));
}

void lanMessages(Folder folder) {
  LanNonce nonce{};
  nonce[0] = 1;
  folder.add(writeLanQuery(nonce));
  LanAnswer answer;
  answer.protocol = kProtocolVersion;
  answer.nonce = nonce;
  answer.port = kDefaultPort;
  answer.max_players = 64;
  answer.name = "Ann's";
  answer.game = "hello";
  folder.add(writeLanAnswer(answer));
}

}  // namespace
}  // namespace naiad::fuzz

int main(int argc, char** argv) {
  using namespace naiad::fuzz;
  if (argc != 2) return 2;
  const std::filesystem::path base(argv[1]);
  frames(Folder(base / "frames"));
  texts(Folder(base / "safe_text"));
  links(Folder(base / "link"));
  visitors(Folder(base / "visitor"));
  gamesLists(Folder(base / "games_list"));
  webRequests(Folder(base / "web_request"));
  busPayloads(Folder(base / "bus_payload"));
  httpResponses(Folder(base / "http_response"));
  webSocketFrames(Folder(base / "websocket_frames"));
  keys(Folder(base / "input_decoder"));
  updates(Folder(base / "update"));
  hostile(Folder(base / "update", "hostile-"), Folder(base / "snapshot_fields"));
  controls(Folder(base / "controls"));
  serverMessages(Folder(base / "server_message"));
  clientMessages(Folder(base / "client_message"));
  beyondLimits(Folder(base / "client_message", "limit-"));
  onTwoStreams(Folder(base / "client_message", "second-"));
  replication(Folder(base / "replication"), Folder(base / "snapshot"));
  datagrams(Folder(base / "datagram"));
  wireMessages(Folder(base / "small_proto"));
  worlds(Folder(base / "world"));
  rounds(Folder(base / "round"));
  lanMessages(Folder(base / "lan"));
  return 0;
}
