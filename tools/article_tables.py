# SPDX-License-Identifier: Apache-2.0
"""Tables 1 to 4 of Fan et al. 2020: RMSE and S.D. of each system, and the tracked frames of all."""

SEQUENCES = ("walking_halfsphere", "walking_rpy", "walking_static", "walking_xyz", "sitting_static")
SYSTEMS = ("ORB-SLAM2", "Dyna-SLAM", "DS-SLAM", "Ours")
TITLES = {"ate": "absolute trajectory error, m",
          "rpe_trans": "relative pose error, translation, m/s",
          "rpe_rot": "relative pose error, rotation, deg/s",
          "tracked": "tracked frames"}

# A row for each of SEQUENCES; RMSE and S.D. of each of SYSTEMS.
_ERRORS = {
    "ate": """0.4543 0.2524 0.0296 0.0157 0.0303 0.0159 0.0241 0.0122
              0.5391 0.2283 0.0354 0.0190 0.4442 0.2350 0.0453 0.0316
              0.3194 0.1819 0.0068 0.0032 0.0081 0.0033 0.0077 0.0039
              0.7521 0.4712 0.0164 0.0086 0.0247 0.0161 0.0157 0.0083
              0.0087 0.0043 0.0108 0.0056 0.0065 0.0033 0.0080 0.0037""",
    "rpe_trans": """0.3216 0.2629 0.0284 0.0149 0.0297 0.0152 0.0274 0.0140
                    0.3880 0.2823 0.0448 0.0262 0.1503 0.1168 0.0616 0.0357
                    0.1928 0.1773 0.0089 0.0044 0.0102 0.0038 0.0102 0.0049
                    0.4834 0.3663 0.0217 0.0119 0.0333 0.0229 0.0204 0.0107
                    0.0095 0.0046 0.0126 0.0067 0.0078 0.0038 0.0087 0.0038""",
    "rpe_rot": """6.6515 5.3990 0.7842 0.4012 0.8142 0.4101 0.7440 0.3459
                  7.5906 5.4768 0.9894 0.5701 3.0042 2.3065 1.3831 0.8319
                  3.5991 3.2457 0.2612 0.1259 0.2690 0.1215 0.2631 0.1119
                  8.8419 6.6762 0.6284 0.3848 0.8266 0.2826 0.6227 0.3807
                  0.2881 0.1244 0.3416 0.1642 0.2735 0.1215 0.2782 0.1210"""}

# A row for each of SEQUENCES: all frames, and the tracked ones of each of SYSTEMS.
_TRACKED = """1021 942 525 1018 1018
              866 825 546 864 864
              717 714 375 714 714
              827 809 757 826 826
              679 675 675 676 676"""


def _rows(text):
    return zip(SEQUENCES, ([float(value) for value in line.split()] for line in text.splitlines()))


TABLES = {key: {name: {system: (row[2 * i], row[2 * i + 1]) for i, system in enumerate(SYSTEMS)} for name, row in _rows(text)}
          for key, text in _ERRORS.items()}
TABLES["tracked"] = {name: {system: (int(row[i + 1]), int(row[0])) for i, system in enumerate(SYSTEMS)}
                     for name, row in _rows(_TRACKED)}
