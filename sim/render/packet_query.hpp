#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace alight::sim {

/// Eight rays through a scene, by whichever Embree is there: 4 (Debian 13) or 3 (Debian 12).
/// @param valid eight numbers, -1 where the ray is wanted, 0 elsewhere; aligned to 32 bytes
/// @param coherent the rays begin near each other and have about the same direction
#if RTC_VERSION_MAJOR >= 4
inline void intersect_packet(RTCScene scene, const int* valid, bool coherent, RTCRayHit8& packet) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &packet, &arguments);
}

/// As above, for whether anything is in the way; tfar is negative afterwards where it is.
inline void occlude_packet(RTCScene scene, const int* valid, bool coherent, RTCRay8& packet) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &packet, &arguments);
}
#else
inline void intersect_packet(RTCScene scene, const int* valid, bool coherent, RTCRayHit8& packet) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &packet);
}

/// Whether anything lies on each ray; `tfar` becomes minus infinity where something does.
inline void occlude_packet(RTCScene scene, const int* valid, bool coherent, RTCRay8& packet) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(valid, scene, &context, &packet);
}
#endif

}  // namespace alight::sim
