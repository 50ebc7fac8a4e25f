"""`python -m trialid` is the command `trialid`."""

from trialid.cli.main import main

if __name__ == "__main__":
    main()
