#include "client/session/SessionOptions.h"

#include <algorithm>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/datagram/DatagramKeys.h"

namespace naiad {
namespace {

std::uint32_t clampedCells(int cells) {
  return static_cast<std::uint32_t>(std::clamp(cells, 0, 9999));
}

}  // namespace

wire::ClientMessage helloOf(const SessionOptions& options) {
  wire::ClientMessage message;
  wire::Hello& hello = *message.mutable_hello();
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name(safeName(options.name));
  hello.set_game(safeText(options.game, 64));
  hello.set_room(options.room);
  hello.set_rooms(true);
  hello.set_program(options.program);
  hello.set_columns(clampedCells(options.columns));
  hello.set_rows(clampedCells(options.rows));
  hello.set_password(options.password);
  hello.set_resume_token(options.resume_token);
  hello.set_new_process(options.new_process);
  hello.set_last_frame(options.last_frame);
  hello.set_second_stream(options.second_stream);
  if (options.open_socket) {
    hello.add_aeads(static_cast<std::uint32_t>(AeadId::kAes128Gcm));
    hello.add_aeads(static_cast<std::uint32_t>(AeadId::kChaCha20Poly1305));
  }
  return message;
}

wire::ClientMessage resizeOf(int columns, int rows) {
  wire::ClientMessage message;
  message.mutable_resize()->set_columns(clampedCells(columns));
  message.mutable_resize()->set_rows(clampedCells(rows));
  return message;
}

}  // namespace naiad
