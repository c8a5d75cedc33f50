// One step of the dynamic programming search: the cheapest way to arrive at each motion node, and to leave it.
// For processors: few wide cores, each of which reads memory in long runs. See min_plus_wide.cl for graphics cards.
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
#include "least_of_columns.cl"

// Columns that stay in the first-level cache while all rows of a group pass over them.
#define TILE 2048u

// ROWS rows go side by side: what is loaded of the front, twice as wide as a piece of a row, then serves all of them.
// The host sets ROWS and LANES, doubles to a vector, to what the processor's registers hold.
#if LANES == 8
typedef double8 doubles;
#define LOAD vload8
#define STORE vstore8
#define CONVERT convert_double8
#else
typedef double4 doubles;
#define LOAD vload4
#define STORE vstore4
#define CONVERT convert_double4
#endif

// A comparison costs less than fmin, which has to think of NaN.
#define LESSER(a, b) select(a, b, (b) < (a))

double least_lane(doubles found)
{
#if LANES == 8
    const double4 four = LESSER(found.lo, found.hi);
#else
    const double4 four = found;
#endif
    return fmin(fmin(four.x, four.y), fmin(four.z, four.w));
}

// Rows of a group's stripe: a multiple of ROWS, so that only the last group meets the padding.
uint rows_of_stripe(uint n_nodes)
{
    const uint share = (n_nodes + get_global_size(0) - 1) / get_global_size(0);
    return (share + ROWS - 1) / ROWS * ROWS;
}

// One work-item is a group that owns a stripe of rows and reads on through it. The host sees to it that there are a few
// groups a core: left to itself, PoCL puts hundreds of work-items into one group, and all of them on one core.
__kernel void min_plus(__global const float *restrict DistanceMap,
                       __global const double *restrict PrevCostBufferMap,
                       __global double *restrict CostValueMap,
                       const uint n_nodes,
                       const uint stride)
{
    const uint rows = rows_of_stripe(n_nodes);
    const uint first = min((uint)get_global_id(0) * rows, n_nodes), last = min(first + rows, n_nodes);
    for (uint m = first; m < last; m += ROWS) {
        __global const float *at = DistanceMap + (ulong)m * stride;
        doubles least[ROWS];
#pragma unroll
        for (uint row = 0; row < ROWS; ++row)
            least[row] = (doubles)(INFINITY);
        for (uint n = 0; n < stride; n += LANES) {
            const doubles front = LOAD(0, PrevCostBufferMap + n);
#pragma unroll
            for (uint row = 0; row < ROWS; ++row) {
                const doubles cost = front + CONVERT(LOAD(0, at + (ulong)row * stride + n));
                least[row] = LESSER(least[row], cost);
            }
        }
#pragma unroll
        for (uint row = 0; row < ROWS; ++row)
            if (m + row < last)
                CostValueMap[m + row] = least_lane(least[row]);
    }
}

// The same stripes; each element is read once for both directions, and the minima of a tile's columns are loaded and
// stored once for ROWS rows.
__kernel void min_plus_both(__global const float *restrict DistanceMap,
                            __global const double *restrict PrevCostBufferMap,
                            __global const double *restrict NextCostBufferMap,
                            __global double *restrict CostValueMap,
                            __global double *restrict CostBuffMap,
                            const uint n_nodes,
                            const uint stride)
{
    const uint group = get_global_id(0);
    const uint rows = rows_of_stripe(n_nodes);
    const uint first = min(group * rows, n_nodes), last = min(first + rows, n_nodes);
    __global double *leaving = CostBuffMap + (ulong)group * stride;
    for (uint n = 0; n < stride; n += LANES)
        STORE((doubles)(INFINITY), 0, leaving + n);
    for (uint m = first; m < last; ++m)
        CostValueMap[m] = INFINITY;
    for (uint tile = 0; tile < stride; tile += TILE) {
        const uint end = min(tile + TILE, stride);
        for (uint m = first; m < last; m += ROWS) {
            doubles least[ROWS], behind[ROWS];
#pragma unroll
            for (uint row = 0; row < ROWS; ++row) {
                least[row] = (doubles)(INFINITY);
                // rows of padding are read, and count for nothing
                behind[row] = (doubles)(m + row < last ? NextCostBufferMap[m + row] : INFINITY);
            }
            for (uint n = tile; n < end; n += LANES) {
                const doubles front = LOAD(0, PrevCostBufferMap + n);
                doubles lowest = LOAD(0, leaving + n);
#pragma unroll
                for (uint row = 0; row < ROWS; ++row) {
                    const doubles cost = CONVERT(LOAD(0, DistanceMap + (ulong)(m + row) * stride + n));
                    const doubles arriving = front + cost, going = behind[row] + cost;
                    least[row] = LESSER(least[row], arriving);
                    lowest = LESSER(lowest, going);
                }
                STORE(lowest, 0, leaving + n);
            }
#pragma unroll
            for (uint row = 0; row < ROWS; ++row)
                if (m + row < last)
                    CostValueMap[m + row] = fmin(CostValueMap[m + row], least_lane(least[row]));
        }
    }
}
