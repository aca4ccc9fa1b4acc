"""What the paper prints, to stand beside ours."""

from __future__ import annotations

#: Table 1: error, HD and CE in percent; without constraints, then with them.
TABLE1 = {"joint": ((1.578, 3.88, 4.39), (1.572, 0.05, 0.09))}
#: Table 2: error of start and end, seconds; QSF, then the paper's method.
TABLE2 = {
    "bone": ((0.2483, 0.0141, 7.939), (0.0339, 0.0140, 1.467)),
    "chess": ((0.0578, 0.0087, 2.214), (0.0325, 0.0070, 0.890)),
    "sample": ((0.2354, 0.0032, 4.085), (0.0269, 0.0030, 0.908)),
}
#: Table 3: thousands of faces, regions, seconds.
TABLE3 = {
    "bone": (30.0, 5, 1.467),
    "chess": (8.5, 10, 0.890),
    "sample": (26.7, 21, 0.908),
    "fandisk": (13.8, 21, 1.497),
    "rolling_stage": (100.0, 23, 2.010),
    "oil_pump": (100.0, 78, 15.43),
    "blade": (390.0, 37, 5.120),
    "part4": (143.0, 93, 14.324),
    "master_cylinder": (100.0, 20, 5.120),
    "grayloc": (69.5, 39, 4.654),
    "carter": (100.0, 38, 6.147),
    "dynamo": (92.5, 28, 3.524),
}
#: Section 5.4, Fig. 7: greatest HD and CE on "twelve".
FIGURE7 = (0.04, 0.08)


def regions_of(name: str) -> int | None:
    """Give the paper's number of regions of a model, where it names one."""
    return TABLE3[name][1] if name in TABLE3 else None
