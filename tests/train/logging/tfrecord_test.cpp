#include "train/logging/tfrecord.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

/// RFC 3720, B.4, and the check value of the CRC catalogues.
TEST(Crc32c, KnownValues) {
  EXPECT_EQ(crc32c(""), 0U);
  EXPECT_EQ(crc32c("123456789"), 0xe3069283U);
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8a9136aaU);
  EXPECT_EQ(crc32c(std::string(32, '\xff')), 0x62a8ab43U);
  std::string ascending;
  for (char c = 0; c < 32; ++c) ascending += c;
  EXPECT_EQ(crc32c(ascending), 0x46dd794eU);
}

/// The payload's CRC 0xe3069283 rotated right by 15 is 0x2507c60d; plus 0xa282ead8 that is 0xc78ab0e5.
TEST(TfRecord, FramesAPayload) {
  const std::string record = tfrecord("123456789");
  ASSERT_EQ(record.size(), 8U + 4U + 9U + 4U);
  EXPECT_EQ(record.substr(0, 8), std::string("\x09\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(record.substr(12, 9), "123456789");
  EXPECT_EQ(record.substr(21), "\xe5\xb0\x8a\xc7");
}

/// An empty record has the CRC of eight zero bytes, 0x8c28b28a, for its length and that of nothing, 0, for its payload.
TEST(TfRecord, FramesNothing) {
  EXPECT_EQ(tfrecord(""), std::string("\0\0\0\0\0\0\0\0\x29\x03\x98\x07\xd8\xea\x82\xa2", 16));
}

}  // namespace
}  // namespace alight
