#include "proto/ParseErrors.h"

#include <google/protobuf/stubs/logging.h>

namespace naiad {

void silenceParseErrors() {
  static const auto previous_handler = google::protobuf::SetLogHandler(nullptr);
  static_cast<void>(previous_handler);
}

}  // namespace naiad
