// The client as a WebAssembly module: the functions that page/module.js calls, and those that it provides.
//
// The page passes texts and messages in buffer(), with their size in bytes. Returned pointers are addresses
// in the module's memory. There is one client at a time, on the page's main thread.
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "client/web/WebClient.h"
#ifdef NAIAD_RECORD
#include "client/bot/TruthRecorder.h"
#endif
#include "shared/values/Version.h"

#define NAIAD_EXPORT(name) __attribute__((used, export_name(#name)))
#define NAIAD_IMPORT(name) __attribute__((import_module("page"), import_name(#name)))

extern "C" {

NAIAD_IMPORT(open) void pageOpen(int stream);
NAIAD_IMPORT(send) void pageSend(int stream, const char* p_bytes, std::size_t size);
NAIAD_IMPORT(unsent) std::size_t pageUnsent(int stream);
NAIAD_IMPORT(close) void pageClose(int stream);
NAIAD_IMPORT(keep) void pageKeep(const char* p_text, std::size_t size);
NAIAD_IMPORT(sound) void pageSound(const char* p_label, std::size_t size, int action, int flags);

}  // extern "C"

namespace {

using naiad::WebClient;
using Clock = std::chrono::steady_clock;

class PagePort : public naiad::PageBridge {
 public:
  void open(int stream) override { pageOpen(stream); }
  void send(int stream, std::string_view frame) override { pageSend(stream, frame.data(), frame.size()); }
  std::size_t unsentBytes(int stream) override { return pageUnsent(stream); }
  void close(int stream) override { pageClose(stream); }
  void saveToken(std::string_view token) override { pageKeep(token.data(), token.size()); }
  void sound(const naiad::SoundLine& sound, bool own) override {
    pageSound(sound.label.data(), sound.label.size(), static_cast<int>(sound.action),
              (sound.music ? 1 : 0) | (sound.loop ? 2 : 0) | (own ? 4 : 0));
  }
};

struct Module {
  PagePort port;
  std::unique_ptr<WebClient> client;
  std::array<char, 65536> in{};
  WebClient::Options options;
  std::vector<std::uint32_t> cells;
  std::string message;
};

Module& module() {
  static Module all;
  return all;
}

std::string_view input(std::size_t from, std::size_t size) {
  const std::string_view all(module().in.data(), module().in.size());
  return from > all.size() ? std::string_view() : all.substr(from, size);
}

/// Packs a cell for the page: character (21 bits, lowest), colour (3), style (2), background (3).
std::uint32_t packed(const naiad::ScreenCell& cell) {
  return static_cast<std::uint32_t>(cell.ch) | static_cast<std::uint32_t>(cell.color & 7) << 21 |
         static_cast<std::uint32_t>(cell.style) << 24 | static_cast<std::uint32_t>(cell.background & 7) << 26;
}

void pack(const naiad::ScreenBuffer& picture, std::vector<std::uint32_t>& cells) {
  cells.clear();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) cells.push_back(packed(picture.at(x, y)));
  }
}

#ifdef NAIAD_RECORD
/// Pictures of the replica by tick, for a test that compares them with the server's truth file.
struct Recording {
  naiad::TruthRecorder recorder;
  std::vector<std::uint32_t> cells;
};

Recording& recording() {
  static Recording all;
  return all;
}

void record(WebClient& client) {
  client.connection().onSession([](naiad::ClientSession& session) {
    session.onBeforeSnapshot(
        [&session](std::uint32_t tick) { recording().recorder.beforeSnapshot(session.replica(), tick); });
    session.onAfterSnapshot([&session](const naiad::SnapshotHeader& header, const naiad::AckWindow& acks) {
      const auto before = session.welcome().resume_state.value_or(naiad::ResumeState());
      recording().recorder.afterSnapshot(header, acks, true, before.snapshot);
    });
  });
}
#endif

}  // namespace

extern "C" {

/// Returns the 64 KiB buffer for data from the page.
NAIAD_EXPORT(buffer) char* webBuffer() {
  return module().in.data();
}

/// Sets an option of the next start() from buffer(): 0 name, 1 password, 2 token, 3 server's name, 4 room.
NAIAD_EXPORT(option) void webOption(int which, std::size_t size) {
  WebClient::Options& options = module().options;
  std::string* const texts[] = {&options.name, &options.password, &options.token, &options.server,
                                &options.room};
  if (which >= 0 && which < 5) *texts[which] = input(0, size);
}

/// Joins with a new client and a picture of columns by rows cells. Destroys an earlier client.
NAIAD_EXPORT(start) void webStart(int columns, int rows) {
  Module& all = module();
  all.client.reset();
  all.options.columns = columns;
  all.options.rows = rows;
  all.options.program = std::string("naiad web ") + naiad::kVersion;
  all.client = std::make_unique<WebClient>(all.port, all.options, Clock::now());
  all.options.password.clear();
#ifdef NAIAD_RECORD
  record(*all.client);
#endif
}

NAIAD_EXPORT(opened) void webOpened(int stream) {
  if (module().client) module().client->streams().opened(stream);
}

NAIAD_EXPORT(received) void webReceived(int stream, std::size_t size) {
  if (module().client) module().client->streams().received(stream, input(0, size));
}

NAIAD_EXPORT(closed) void webClosed(int stream, int code, std::size_t size) {
  if (module().client) module().client->streams().closed(stream, code, input(0, size));
}

/// buffer() has KeyboardEvent.key (`key` bytes) and .code (`code` bytes). `action`: 0 down, 1 repeat, 2 up.
NAIAD_EXPORT(key) void webKey(std::size_t key, std::size_t code, int action, int modifiers) {
  if (!module().client || action < 0 || action > 2) return;
  module().client->pressKey(input(0, key), input(key, code), static_cast<naiad::KeyEvent::Action>(action),
                            static_cast<std::uint8_t>(modifiers), Clock::now());
}

/// `action`: 0 press, 1 drag, 2 move, 3 release; `button`: df::Mouse::Button.
NAIAD_EXPORT(mouse) void webMouse(int x, int y, int button, int action) {
  if (!module().client || action < 0 || action > 3 || button < -1 || button > 2) return;
  module().client->moveMouse(
      {x, y, static_cast<df::Mouse::Button>(button), static_cast<naiad::MouseEvent::Action>(action)},
      Clock::now());
}

NAIAD_EXPORT(command) void webCommand(int letter) {
  if (module().client && letter >= 'a' && letter <= 'z')
    module().client->command(static_cast<char32_t>(letter), Clock::now());
}

NAIAD_EXPORT(chat) void webChat(std::size_t size) {
  if (module().client) module().client->setChatText(input(0, size));
}

NAIAD_EXPORT(blur) void webBlur() {
  if (module().client) module().client->releaseKeys(Clock::now());
}

NAIAD_EXPORT(resize) void webResize(int columns, int rows) {
  if (module().client) module().client->resize(columns, rows);
}

NAIAD_EXPORT(update) void webUpdate() {
  if (module().client) module().client->update(Clock::now());
}

/// Composes a picture. Returns 1 if it is new, else 0.
NAIAD_EXPORT(compose) int webCompose() {
  Module& all = module();
  if (!all.client || !all.client->compose(Clock::now())) return 0;
  pack(all.client->picture(), all.cells);
  return 1;
}

NAIAD_EXPORT(cells) const std::uint32_t* webCells() {
  return module().cells.data();
}

NAIAD_EXPORT(columns) int webColumns() {
  return module().client ? module().client->picture().width() : 0;
}

NAIAD_EXPORT(rows) int webRows() {
  return module().client ? module().client->picture().height() : 0;
}

/// Returns the position of the text cursor as row · 65536 + column; −1: none.
NAIAD_EXPORT(cursor) int webCursor() {
  if (!module().client) return -1;
  const auto& cursor = module().client->picture().cursor;
  return cursor ? cursor->y * 65536 + cursor->x : -1;
}

/// Returns the WebClient::State; kLeft without a client.
NAIAD_EXPORT(state) int webState() {
  return module().client ? static_cast<int>(module().client->state())
                         : static_cast<int>(WebClient::State::kLeft);
}

NAIAD_EXPORT(writing) int webWriting() {
  return module().client && module().client->isChatOpen() ? 1 : 0;
}

/// Updates the text that message() returns. Returns its size in bytes.
NAIAD_EXPORT(sentence_size) std::size_t webSentenceSize() {
  module().message = module().client ? module().client->message() : "";
  return module().message.size();
}

NAIAD_EXPORT(message) const char* webMessage() {
  return module().message.data();
}

/// Returns the size of the game's view as height · 65536 + width.
NAIAD_EXPORT(view) int webView() {
  const WebClient* p_client = module().client.get();
  return p_client != nullptr ? p_client->viewHeight() * 65536 + p_client->viewWidth() : 24 * 65536 + 80;
}

#ifdef NAIAD_RECORD
NAIAD_EXPORT(recorded) int webRecorded() {
  return static_cast<int>(recording().recorder.tickCount());
}

/// Returns the tick of picture `index`; recorded_cells() then returns its cells.
NAIAD_EXPORT(recorded_tick) std::uint32_t webRecordedTick(int index) {
  auto found = recording().recorder.pictures().begin();
  std::advance(found, index);
  const df::Canvas& canvas = found->second;
  std::vector<std::uint32_t>& cells = recording().cells;
  cells.clear();
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x)
      cells.push_back(packed({canvas.at(x, y).ch, canvas.at(x, y).color}));
  }
  return found->first;
}

NAIAD_EXPORT(recorded_cells) const std::uint32_t* webRecordedCells() {
  return recording().cells.data();
}

/// Returns the size of the pictures as height · 65536 + width; 0 without pictures.
NAIAD_EXPORT(recorded_size) int webRecordedSize() {
  const auto& pictures = recording().recorder.pictures();
  if (pictures.empty()) return 0;
  return pictures.begin()->second.height() * 65536 + pictures.begin()->second.width();
}
#endif

}  // extern "C"
