"""The benchmark in the box: error injection, scoring, the demo take."""
