"""What the workstation knows and computes. No Qt, no GL, no CL."""
