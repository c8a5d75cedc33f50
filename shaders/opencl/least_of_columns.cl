// The least of each column of what several groups found. One work-item owns one column. For min_plus.cl, min_plus_wide.cl.
//
// CostBuffMap         double (n_groups rows of `stride`), cheapest departure as far as each group's rows tell
// LeavingValueMap     double (stride), result: cheapest departure
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
