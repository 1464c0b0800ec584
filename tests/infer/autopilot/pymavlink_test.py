"""Frames of mavlink_samples (standard input) against pymavlink: what it packs from the same fields has to be the same
bytes, and what its parser makes of ours the same fields."""
import struct
import sys

from pymavlink.dialects.v20 import common

SYSTEM_ID, COMPONENT_ID = 3, 191


def float32(text):
    return struct.unpack("<f", struct.pack("<f", float(text)))[0]


def message_of(name, fields):
    if name == "HEARTBEAT":
        return common.MAVLink_heartbeat_message(*map(int, fields))
    numbers = [int(f) for f in fields[:3]] + [float32(f) for f in fields[3:15]] + [int(f) for f in fields[15:]]
    return common.MAVLink_landing_target_message(*numbers[:11], numbers[11:15], *numbers[15:])


def main():
    packer = common.MAVLink(None, srcSystem=SYSTEM_ID, srcComponent=COMPONENT_ID)
    parser = common.MAVLink(None)
    parser.robust_parsing = False  # raises at a bad checksum
    frames = 0
    for line in sys.stdin:
        name, *fields, ours = line.split()
        expected = message_of(name, fields)
        theirs = bytes(expected.pack(packer))
        packer.seq = (packer.seq + 1) % 256
        if bytes.fromhex(ours) != theirs:
            sys.exit(f"frame {frames} ({name}): ours {ours}, pymavlink's {theirs.hex()}")
        parsed = parser.parse_buffer(bytes.fromhex(ours))
        if not parsed or len(parsed) != 1:
            sys.exit(f"frame {frames} ({name}): pymavlink reads {parsed}")
        if parsed[0].to_dict() != expected.to_dict():
            sys.exit(f"frame {frames}: pymavlink reads {parsed[0]} instead of {expected}")
        frames += 1
    if frames != 600:
        sys.exit(f"{frames} frames instead of 600")
    print(f"{frames} frames are pymavlink's byte for byte, and read back field by field")


main()
