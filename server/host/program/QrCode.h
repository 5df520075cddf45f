// A text as a QR code of characters, for phones that look at a terminal.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Lines of half blocks, two modules high, with the quiet zone of four modules that ISO/IEC 18004 asks for.
/// Light modules are drawn and dark ones left out, as fits a dark terminal; phones read the reverse as well.
/// Empty if this program was built without libqrencode, or the text is longer than a code holds (some 2,900
/// bytes).
std::vector<std::string> qrCode(const std::string& text);

}  // namespace naiad
