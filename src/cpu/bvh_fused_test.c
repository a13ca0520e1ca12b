/* bvh_fused_test.c - bvh_leak_test.c with a traversal that has fused multiply-adds: CMakeLists.txt says so to the compiler. */
#include "cpu/bvh_leak_test.c"
#include "cpu/bvh_trace.c"
