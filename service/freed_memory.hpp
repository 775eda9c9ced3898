#pragma once

namespace telltale {

/// Gives the memory back to the system that has been freed and that the heaps of glibc keep. A
/// computation leaves holes of tens of megabytes in the heap of its thread, between small blocks
/// that stay.
void ReturnFreedMemory();

}  // namespace telltale
