#version 430
// One step backward of the dynamic programming search: the cheapest way to leave each motion node.
//
// One thread owns one motion node n and walks down its column; the threads of a group read side by side.
// Reference: core/search/compute.py, NumpyKernels.min_plus_both. Sums are double, so results equal it bit by bit.
// The matrix is handed over in pieces of whole rows; each piece lowers what the pieces before it found.
//
// DistanceMap         float  (n_rows times n_nodes), cost of following n by m, row m
// NextCostBufferMap   double (n_nodes), cost of the best path that starts in m, m's own cost included
// LeavingValueMap     double (n_nodes), result
layout(local_size_x = THREADS) in;

layout(std430, binding = 0) readonly buffer Distances { float DistanceMap[]; };
layout(std430, binding = 1) readonly buffer NextCosts { double NextCostBufferMap[]; };
layout(std430, binding = 2) buffer LeavingValues { double LeavingValueMap[]; };

uniform uint n_nodes;
uniform uint first_row;
uniform uint n_rows;

void main()
{
    const uint n = gl_GlobalInvocationID.x;
    if (n >= n_nodes)
        return;
    double found = first_row == 0u ? double(uintBitsToFloat(0x7f800000u)) : LeavingValueMap[n];
    for (uint m = 0u; m < n_rows; ++m)
        found = min(found, NextCostBufferMap[first_row + m] + double(DistanceMap[m * n_nodes + n]));
    LeavingValueMap[n] = found;
}
