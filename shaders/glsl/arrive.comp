#version 430
// One step of the dynamic programming search: the cheapest way to arrive at each motion node.
//
// One work group owns one motion node m: its threads read the row side by side, then agree on the least.
// Reference: core/search/compute.py, NumpyKernels.min_plus. Sums are double, so results equal the reference bit by bit.
// The matrix is handed over in pieces of whole rows, as a buffer may hold only so much; `first_row` is the piece's.
//
// DistanceMap         float  (rows of the piece times n_nodes), cost of following n by m, row m
// PrevCostBufferMap   double (n_nodes), cost of the best path that ends in n
// CostValueMap        double (n_nodes), result
layout(local_size_x = THREADS) in;

layout(std430, binding = 0) readonly buffer Distances { float DistanceMap[]; };
layout(std430, binding = 1) readonly buffer PrevCosts { double PrevCostBufferMap[]; };
layout(std430, binding = 2) writeonly buffer CostValues { double CostValueMap[]; };

uniform uint n_nodes;
uniform uint first_row;

shared double least[THREADS];

void main()
{
    const uint row = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x;
    const uint start = row * n_nodes;
    double found = double(uintBitsToFloat(0x7f800000u));
    for (uint n = thread; n < n_nodes; n += THREADS)
        found = min(found, PrevCostBufferMap[n] + double(DistanceMap[start + n]));
    least[thread] = found;
    barrier();
    for (uint reach = THREADS / 2; reach > 0; reach /= 2) {
        if (thread < reach)
            least[thread] = min(least[thread], least[thread + reach]);
        barrier();
    }
    if (thread == 0)
        CostValueMap[first_row + row] = least[0];
}
