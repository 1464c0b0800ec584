#pragma once

namespace alight {

/// What a `bind` function visits fields with (foundation/config_reader.hpp). Headers that only declare one need no more: the
/// reader and yaml-cpp behind it take longer to parse than most of our headers.
class Binder;

}  // namespace alight
