#pragma once

#include <string>

#include "infer/web/listen_address.hpp"

namespace alight {

/// 128 random bits from the system as 32 hexadecimal digits.
std::string random_token();

/// Takes the same time wherever the two differ.
bool equal_in_constant_time(const std::string& a, const std::string& b);

/// Whether the Host header of a request names this server. A page elsewhere can make its own name resolve to this
/// computer (DNS rebinding) and would then count as the same origin; it cannot do so to an address, to "localhost" or to
/// this computer's names, and nothing else passes.
bool names_this_server(const std::string& host_header, const ListenAddress& address);

/// Whether a request comes from our own page or from no page at all: browsers name the page in Origin when they post.
/// @param origin empty: the header is absent
bool comes_from_own_page(const std::string& origin, const std::string& host_header);

}  // namespace alight
