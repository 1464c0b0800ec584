#include "sensors/stream/repeat_guard.hpp"

#include <algorithm>
#include <string_view>

#include "foundation/content_hash.hpp"

namespace alight {
namespace {

constexpr std::size_t kRemembered = 4;

}  // namespace

bool RepeatGuard::repeated(const RawMessage& message) {
  std::string hash =
      content_hash(std::string_view(reinterpret_cast<const char*>(message.data), message.size));
  if (std::find(last_.begin(), last_.end(), hash) != last_.end()) return true;
  last_.push_back(std::move(hash));
  if (last_.size() > kRemembered) last_.pop_front();
  return false;
}

}  // namespace alight
