// Silences the wire codec.
#pragma once

namespace naiad {

/// Stops the codec from printing. The protobuf library reports malformed text on stderr, so that a peer could
/// write on a player's screen or fill a host's log; parsing also returns false, which is enough. Call before
/// the first message is parsed; repeated calls are cheap. Thread-safe.
void silenceParseErrors();

}  // namespace naiad
