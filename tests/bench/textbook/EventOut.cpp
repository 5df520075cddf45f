#include "Book.h"

namespace textbook {

EventOut::EventOut() {
  setType(OUT_EVENT);
}

}  // namespace textbook
