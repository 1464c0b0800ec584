#pragma once

#include <functional>

namespace alight::sim {

/// Calls work(row) once for every row of 0 .. rows-1, on `threads` threads (0: as many as the machine has). Rows are
/// handed out one by one, so the threads end together. The first exception of `work` is rethrown here.
/// Our own threads and not OpenCV's: Embree, told to build with one thread, holds all of TBB to one.
void parallel_rows(int threads, int rows, const std::function<void(int row)>& work);

}  // namespace alight::sim
