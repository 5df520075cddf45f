// Silences the wire codec.
#pragma once

namespace naiad {

/// Stops the codec from printing. The protobuf library would report malformed text on stderr, so a peer could
/// write on a player's screen or fill a host's log; that parsing returns false is enough. Call before the
/// first message is parsed; repeated calls are cheap. Thread-safe.
void silenceParseErrors();

}  // namespace naiad
