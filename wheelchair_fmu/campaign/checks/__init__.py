"""What can be wrong with a campaign: one small function per fault, in six registers.

A check gets the thing it judges and yields its faults. It never raises and never stops the others.
"""

from .campaign import CAMPAIGN_CHECKS, Assembly
from .clock import CLOCK_CHECKS
from .document import DOCUMENT_CHECKS
from .file import FILE_CHECKS
from .headings import HEADING_CHECKS
from .run import RUN_CHECKS

__all__ = ["CAMPAIGN_CHECKS", "CLOCK_CHECKS", "DOCUMENT_CHECKS", "FILE_CHECKS", "HEADING_CHECKS", "RUN_CHECKS", "Assembly"]
