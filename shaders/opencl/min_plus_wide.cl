// One step of the dynamic programming search: the cheapest way to arrive at each motion node, and to leave it.
// For graphics cards: many narrow threads, which read side by side. See min_plus.cl for processors, and for the buffers.
//
// Reference: core/search/compute.py, NumpyKernels.min_plus and min_plus_both. Sums are double, so results equal it.
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "least_of_columns.cl"

// One work-group of THREADS owns one row: its threads read side by side, then agree on the least.
__kernel void arrive(__global const float *restrict DistanceMap,
                     __global const double *restrict PrevCostBufferMap,
                     __global double *restrict CostValueMap,
                     const uint stride)
{
    __local double least[THREADS];
    const uint row = get_group_id(0), thread = get_local_id(0);
    __global const float *at = DistanceMap + (ulong)row * stride;
    double found = INFINITY;
    for (uint n = thread; n < stride; n += THREADS)
        found = fmin(found, PrevCostBufferMap[n] + (double)at[n]);
    least[thread] = found;
    for (uint reach = THREADS / 2; reach > 0; reach /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (thread < reach)
            least[thread] = fmin(least[thread], least[thread + reach]);
    }
    if (thread == 0)
        CostValueMap[row] = least[0];
}

// One work-item owns one column (first index) of a stripe of rows (second index) and walks down it.
__kernel void leave(__global const float *restrict DistanceMap,
                    __global const double *restrict NextCostBufferMap,
                    __global double *restrict CostBuffMap,
                    const uint n_nodes,
                    const uint stride)
{
    const uint n = get_global_id(0), stripe = get_global_id(1);
    const uint rows = (n_nodes + get_global_size(1) - 1) / get_global_size(1);
    const uint first = min(stripe * rows, n_nodes), last = min(first + rows, n_nodes);
    double found = INFINITY;
    for (uint m = first; m < last; ++m)
        found = fmin(found, NextCostBufferMap[m] + (double)DistanceMap[(ulong)m * stride + n]);
    CostBuffMap[(ulong)stripe * stride + n] = found;
}
