"""What is kept from one run to the next: where it lies, and of which source it is."""

from trialid.cache.folder import cache_folder, is_ours_alone
from trialid.cache.sources import source_digest

__all__ = ["cache_folder", "is_ours_alone", "source_digest"]
