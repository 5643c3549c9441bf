import sys

from deltaviz.cli import main

sys.exit(main())
