// One step of the dynamic programming search: the cheapest way to arrive at each motion node, and to leave it.
//
// References: core/search/compute.py, NumpyKernels.min_plus and min_plus_both. Sums are double, so results equal the
// reference bit by bit. The names of the buffers are those of Deng and Neumann 2008, table 3.
//
// DistanceMap         float  (n_nodes rows of `stride`, rows padded to a multiple of ROWS), cost of following n by m,
//                     row m; padded with 0
// PrevCostBufferMap   double (stride), cost of the best path that ends in n; padded with infinity
// NextCostBufferMap   double (n_nodes), cost of the best path that starts in m, m's own cost included
// CostValueMap        double (n_nodes), result: cheapest arrival
// CostBuffMap         double (n_groups rows of `stride`), cheapest departure as far as each group's rows tell
// LeavingValueMap     double (stride), result: cheapest departure
#pragma OPENCL EXTENSION cl_khr_fp64 : enable

// Columns that stay in the first-level cache while all rows of a group pass over them.
#define TILE 2048u

// One work-item owns ROWS motion nodes and reads their rows side by side: what it loads of the front, twice as wide as a
// piece of a row, then serves all of them. A comparison costs less than fmin, which has to think of NaN.
#define LESSER(a, b) select(a, b, (b) < (a))

__kernel void min_plus(__global const float *restrict DistanceMap,
                       __global const double *restrict PrevCostBufferMap,
                       __global double *restrict CostValueMap,
                       const uint n_nodes,
                       const uint stride)
{
    const uint first = get_global_id(0) * ROWS;
    __global const float *rows = DistanceMap + (ulong)first * stride;
    double4 least[ROWS];
#pragma unroll
    for (uint row = 0; row < ROWS; ++row)
        least[row] = (double4)(INFINITY);
    for (uint n = 0; n < stride; n += 8) {
        const double4 front0 = vload4(0, PrevCostBufferMap + n);
        const double4 front1 = vload4(0, PrevCostBufferMap + n + 4);
#pragma unroll
        for (uint row = 0; row < ROWS; ++row) {
            __global const float *at = rows + (ulong)row * stride + n;
            const double4 cost0 = front0 + convert_double4(vload4(0, at));
            const double4 cost1 = front1 + convert_double4(vload4(0, at + 4));
            least[row] = LESSER(least[row], cost0);
            least[row] = LESSER(least[row], cost1);
        }
    }
#pragma unroll
    for (uint row = 0; row < ROWS; ++row)
        if (first + row < n_nodes)
            CostValueMap[first + row] =
                fmin(fmin(least[row].x, least[row].y), fmin(least[row].z, least[row].w));
}

// One work-item is a group that owns a stripe of rows, and reads each element of it once for both directions; ROWS rows
// go side by side, so that the minima of a tile's columns are loaded and stored once for them.
__kernel void min_plus_both(__global const float *restrict DistanceMap,
                            __global const double *restrict PrevCostBufferMap,
                            __global const double *restrict NextCostBufferMap,
                            __global double *restrict CostValueMap,
                            __global double *restrict CostBuffMap,
                            const uint n_nodes,
                            const uint stride)
{
    const uint group = get_global_id(0);
    const uint share = (n_nodes + get_global_size(0) - 1) / get_global_size(0);
    const uint rows = (share + ROWS - 1) / ROWS * ROWS;
    const uint first = min(group * rows, n_nodes), last = min(first + rows, n_nodes);
    __global double *leaving = CostBuffMap + (ulong)group * stride;
    for (uint n = 0; n < stride; n += 4)
        vstore4((double4)(INFINITY), 0, leaving + n);
    for (uint m = first; m < last; ++m)
        CostValueMap[m] = INFINITY;
    for (uint tile = 0; tile < stride; tile += TILE) {
        const uint end = min(tile + TILE, stride);
        for (uint m = first; m < last; m += ROWS) {
            double4 least[ROWS], behind[ROWS];
#pragma unroll
            for (uint row = 0; row < ROWS; ++row) {
                least[row] = (double4)(INFINITY);
                // rows of padding are read, and count for nothing
                behind[row] = (double4)(m + row < last ? NextCostBufferMap[m + row] : INFINITY);
            }
            for (uint n = tile; n < end; n += 4) {
                const double4 front = vload4(0, PrevCostBufferMap + n);
                double4 lowest = vload4(0, leaving + n);
#pragma unroll
                for (uint row = 0; row < ROWS; ++row) {
                    const double4 cost = convert_double4(vload4(0, DistanceMap + (ulong)(m + row) * stride + n));
                    const double4 arriving = front + cost, going = behind[row] + cost;
                    least[row] = LESSER(least[row], arriving);
                    lowest = LESSER(lowest, going);
                }
                vstore4(lowest, 0, leaving + n);
            }
#pragma unroll
            for (uint row = 0; row < ROWS; ++row)
                if (m + row < last)
                    CostValueMap[m + row] = fmin(CostValueMap[m + row],
                        fmin(fmin(least[row].x, least[row].y), fmin(least[row].z, least[row].w)));
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
