// Bytes as they are, on a TCP socket.
#pragma once

#include "shared/net/stream/ByteStream.h"

namespace naiad {

class PlainStream : public ByteStream {
 public:
  using ByteStream::ByteStream;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  Outcome end() override;
};

}  // namespace naiad
