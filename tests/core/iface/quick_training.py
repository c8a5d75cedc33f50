"""Settings by which small faces are trained in a moment."""

from __future__ import annotations

from core.iface.descent import DescentSettings
from core.iface.modern_training import ModernSettings
from core.iface.paper_training import PaperSettings

# the corpus that they learn from opens its mouth by loudness alone, so loudness must tell
QUICK_MODERN = ModernSettings(
    n_ears=1,
    ear_hidden=(16,),
    ear=DescentSettings(n_passes=3),
    n_nets=2,
    hidden=(24, 12),
    n_back=4,
    loudness=0.1,
    cepstra_weight=1.0,
    descent=DescentSettings(n_passes=40, batch=64, noise=0.2),
)
QUICK_PAPER = PaperSettings(n_components=2, fewest=30, n_steps=40)
