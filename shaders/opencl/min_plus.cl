// One step of the dynamic programming search: the cheapest way to arrive at each motion node, and to leave it.
//
// References: core/search/compute.py, NumpyKernels.min_plus and min_plus_both. Sums are double, so results equal the
// reference bit by bit. The names of the buffers are those of Deng and Neumann 2008, table 3.
//
// DistanceMap         float  (n_nodes rows of `stride`), cost of following n by m, row m; padded with 0
// PrevCostBufferMap   double (stride), cost of the best path that ends in n; padded with infinity
// NextCostBufferMap   double (n_nodes), cost of the best path that starts in m, m's own cost included
// CostValueMap        double (n_nodes), result: cheapest arrival
// CostBuffMap         double (n_groups rows of `stride`), cheapest departure as far as each group's rows tell
// LeavingValueMap     double (stride), result: cheapest departure
#pragma OPENCL EXTENSION cl_khr_fp64 : enable

// Columns that stay in the first-level cache while all rows of a group pass over them.
#define TILE 1024u

// One work-item owns one motion node m and reads its row once, contiguously.
__kernel void min_plus(__global const float *restrict DistanceMap,
                       __global const double *restrict PrevCostBufferMap,
                       __global double *restrict CostValueMap,
                       const uint n_nodes,
                       const uint stride)
{
    const uint m = get_global_id(0);
    if (m >= n_nodes)
        return;
    __global const float *row = DistanceMap + (ulong)m * stride;
    // four independent minima hide the latency of fmin
    double4 least0 = (double4)(INFINITY), least1 = least0, least2 = least0, least3 = least0;
    for (uint n = 0; n < stride; n += 16) {
        least0 = fmin(least0, vload4(0, PrevCostBufferMap + n) + convert_double4(vload4(0, row + n)));
        least1 = fmin(least1, vload4(0, PrevCostBufferMap + n + 4) + convert_double4(vload4(0, row + n + 4)));
        least2 = fmin(least2, vload4(0, PrevCostBufferMap + n + 8) + convert_double4(vload4(0, row + n + 8)));
        least3 = fmin(least3, vload4(0, PrevCostBufferMap + n + 12) + convert_double4(vload4(0, row + n + 12)));
    }
    const double4 least = fmin(fmin(least0, least1), fmin(least2, least3));
    CostValueMap[m] = fmin(fmin(least.x, least.y), fmin(least.z, least.w));
}

// One work-item is a group that owns a stripe of rows, and reads each element of it once for both directions.
__kernel void min_plus_both(__global const float *restrict DistanceMap,
                            __global const double *restrict PrevCostBufferMap,
                            __global const double *restrict NextCostBufferMap,
                            __global double *restrict CostValueMap,
                            __global double *restrict CostBuffMap,
                            const uint n_nodes,
                            const uint stride)
{
    const uint group = get_global_id(0);
    const uint rows = (n_nodes + get_global_size(0) - 1) / get_global_size(0);
    const uint first = min(group * rows, n_nodes), last = min(first + rows, n_nodes);
    __global double *leaving = CostBuffMap + (ulong)group * stride;
    for (uint n = 0; n < stride; n += 4)
        vstore4((double4)(INFINITY), 0, leaving + n);
    for (uint m = first; m < last; ++m)
        CostValueMap[m] = INFINITY;
    for (uint tile = 0; tile < stride; tile += TILE) {
        const uint end = min(tile + TILE, stride);
        for (uint m = first; m < last; ++m) {
            __global const float *row = DistanceMap + (ulong)m * stride;
            const double4 behind = (double4)(NextCostBufferMap[m]);
            double4 least0 = (double4)(INFINITY), least1 = least0;
            for (uint n = tile; n < end; n += 8) {
                const double4 cost0 = convert_double4(vload4(0, row + n));
                const double4 cost1 = convert_double4(vload4(0, row + n + 4));
                least0 = fmin(least0, vload4(0, PrevCostBufferMap + n) + cost0);
                least1 = fmin(least1, vload4(0, PrevCostBufferMap + n + 4) + cost1);
                vstore4(fmin(vload4(0, leaving + n), behind + cost0), 0, leaving + n);
                vstore4(fmin(vload4(0, leaving + n + 4), behind + cost1), 0, leaving + n + 4);
            }
            const double4 least = fmin(least0, least1);
            CostValueMap[m] = fmin(CostValueMap[m], fmin(fmin(least.x, least.y), fmin(least.z, least.w)));
        }
    }
}

// One work-item owns one column: the least of what the groups found.
__kernel void least_of_columns(__global const double *restrict CostBuffMap,
                               __global double *restrict LeavingValueMap,
                               const uint n_groups,
                               const uint stride)
{
    const uint n = get_global_id(0);
    double least = INFINITY;
    for (uint group = 0; group < n_groups; ++group)
        least = fmin(least, CostBuffMap[(ulong)group * stride + n]);
    LeavingValueMap[n] = least;
}
