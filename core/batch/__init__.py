"""Many independent pieces of work: on all cores or a cluster, resumed where a kill cut them."""
