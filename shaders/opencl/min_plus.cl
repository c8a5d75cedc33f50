// One step of the dynamic programming search: the cheapest way to arrive at each motion node.
//
// One work-item owns one motion node m and reads its row of the transition matrix once, contiguously.
// Reference: core/search/compute.py, NumpyKernels.min_plus. Sums are double, so results equal the reference bit by bit.
//
// DistanceMap         float  (n_nodes rows of `stride`), cost of following n by m, row m; padded with 0
// PrevCostBufferMap   double (stride), cost of the best path that ends in n; padded with infinity
// CostValueMap        double (n_nodes), result
#pragma OPENCL EXTENSION cl_khr_fp64 : enable

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
