"""What is kept from one run to the next: where it lies, and of which source it is."""

from trialid.cache.kept_where import cache_folder, is_ours_alone
from trialid.cache.package_digest import source_digest

__all__ = ["cache_folder", "is_ours_alone", "source_digest"]
